// Writing what is made while the next is made.
#ifndef BRDFIT_CLI_WRITE_BEHIND_H_
#define BRDFIT_CLI_WRITE_BEHIND_H_

#include <tbb/task_group.h>

#include <utility>

namespace brdfit::cli {

// One piece of work at a time, beside what its owner does. What it refers to must outlive this.
class WriteBehind {
 public:
  WriteBehind() = default;
  WriteBehind(const WriteBehind&) = delete;
  WriteBehind& operator=(const WriteBehind&) = delete;
  // Whoever leaves without waiting has an error of its own to tell.
  ~WriteBehind() {
    try {
      work_.wait();
    } catch (...) {
    }
  }

  // Waits for the piece before.
  template <class Work>
  void begin(Work work) {
    wait();
    work_.run(std::move(work));
  }
  // Throws what the work threw.
  void wait() { work_.wait(); }

 private:
  tbb::task_group work_;
};

}  // namespace brdfit::cli

#endif  // BRDFIT_CLI_WRITE_BEHIND_H_

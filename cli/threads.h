// Limits the threads of a subcommand while it lives.
#ifndef BRDFIT_CLI_THREADS_H_
#define BRDFIT_CLI_THREADS_H_

#include <tbb/global_control.h>

#include <memory>

namespace brdfit::cli {

class ThreadLimit {
 public:
  // 0: no limit.
  explicit ThreadLimit(int threads) {
    if (threads > 0) {
      control_ = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                       static_cast<std::size_t>(threads));
    }
  }

 private:
  std::unique_ptr<tbb::global_control> control_;
};

}  // namespace brdfit::cli

#endif  // BRDFIT_CLI_THREADS_H_

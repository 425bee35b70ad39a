// A run split over machines: which files are whose.
#ifndef BRDFIT_CLI_SHARD_H_
#define BRDFIT_CLI_SHARD_H_

#include <string>
#include <vector>

namespace brdfit::cli {

// Part `index` of `count`, counted from 1.
struct Shard {
  int index = 1;
  int count = 1;

  bool is_whole() const { return count == 1; }
};

// "2/8". Throws UsageError when that is not what the text says.
Shard parse_shard(const std::string& text);

// Every count-th of the files, beginning with the index-th: machines with files of alike sizes get alike
// work.
std::vector<std::string> files_of_shard(const std::vector<std::string>& files, const Shard& shard);

}  // namespace brdfit::cli

#endif  // BRDFIT_CLI_SHARD_H_

// What decides the result of a bake: whether what an interrupted one left is of the same.
#ifndef BRDFIT_CLI_BAKE_KEY_H_
#define BRDFIT_CLI_BAKE_KEY_H_

#include <CLI/CLI.hpp>
#include <string>

#include "cli/bake_options.h"
#include "io/json.h"
#include "io/stack_source.h"

namespace brdfit::cli {

// {"version", "instructions", "stack": SHA-256 of the manifest, "lobe_set": SHA-256, "options": {name:
// value}, "inputs": {file: size and time of change}}. Options are all of the parser's, as given or by
// default, but for those that change nothing of the result (threads, memory, ...): one that is added later
// decides unless it is named among these. Pictures are known by size and time of change, as to read them all
// would take as long as to decode them. Throws io::IoError (kInput) for a file that cannot be read.
io::Json bake_key(const CLI::App& parser, const BakeArguments& a, const io::StackSource& source);

// What tells two keys apart, in words that follow "as": "--lobes is 4 and was 8". Empty where they are equal.
std::string difference_of_keys(const io::Json& now, const io::Json& before);

}  // namespace brdfit::cli

#endif  // BRDFIT_CLI_BAKE_KEY_H_

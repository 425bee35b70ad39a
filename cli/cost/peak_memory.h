// The most memory that a piece of work held.
#ifndef BRDFIT_CLI_COST_PEAK_MEMORY_H_
#define BRDFIT_CLI_COST_PEAK_MEMORY_H_

namespace brdfit::cli {

// Gives freed memory back to the system and makes the process' peak what it holds now (Linux: 5 written to
// /proc/self/clear_refs). False where the system does not allow that: peaks then are those of all that went
// before.
bool reset_peak_memory();

// The most that the process has held since, in MiB, everything that it holds included: the peak of the
// resident set (VmHWM of /proc/self/status). NaN where the system does not say.
double peak_memory_mib();

}  // namespace brdfit::cli

#endif  // BRDFIT_CLI_COST_PEAK_MEMORY_H_

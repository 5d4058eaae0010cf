// farm_jobs.h: Cuts a sequence into commands of about equal cost for the machines of a farm:
// --jobs. [main thread]
#pragma once

#include <string>
#include <vector>

#include "options/options.h"
#include "xvrml/browser.h"

namespace vv {

// Draws a few frames of a running world in small, and returns a line for each job.
std::string farmJobs(const Options& options, const std::vector<std::string>& words,
                     xvrml::Browser& browser);

} // namespace vv

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <istream>
#include <string>
#include <string_view>
#include <vector>

namespace vernier::apps {

/// A line of a list of jobs.
struct JobLine {
  int number = 0;  ///< from 1
  std::vector<std::string> words;
};

/// The words of a line as a shell would take them: parted by spaces, '...' as it is, "..." with a backslash
/// before what it is to take from its meaning, # to the end for comments. Nothing is expanded. Throws
/// Error(input) on a quote that does not end.
std::vector<std::string> split_words(std::string_view line);

/// Every line that has words. A backslash at its end joins a line to the next; "vernier render" in front may
/// be left out. Throws Error(input) that names the list and the line.
std::vector<JobLine> read_job_list(std::istream& stream, const std::string& name);

/// "line 3"
std::string place_of(const JobLine& line);

}  // namespace vernier::apps

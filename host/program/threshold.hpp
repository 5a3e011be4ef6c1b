// A threshold of the command line: a number of at least 0, or a word that stands for one.
// SPDX-License-Identifier: MIT
#pragma once

#include <initializer_list>
#include <string>
#include <utility>

namespace clgi::program {

// Throws Error "render: --low-res is 'x', off or a threshold of at least 0 needed" with the words
// that are known.
float parse_threshold(const std::string& flag, const std::string& text,
                      std::initializer_list<std::pair<const char*, float>> words);

}  // namespace clgi::program

// How long work reports how far it is.
// SPDX-License-Identifier: MIT
#pragma once

#include <functional>

namespace clgi {

// Called between the parts of long work with the share done, [0,1]; false cancels what is left.
using Progress = std::function<bool(double done)>;

}  // namespace clgi

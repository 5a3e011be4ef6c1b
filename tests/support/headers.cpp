// Nothing: the target that owns the precompiled headers of tests needs a source.
// SPDX-License-Identifier: MIT

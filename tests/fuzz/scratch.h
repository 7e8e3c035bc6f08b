// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace framewatch::test {

/// Returns a folder of this process below TMPDIR. The caller that sets TMPDIR removes it.
const std::string& scratch_folder();

void write_scratch_file(const std::string& path, const void* data, std::size_t size);

}  // namespace framewatch::test

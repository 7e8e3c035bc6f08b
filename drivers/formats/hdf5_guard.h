#pragma once

#include <string>

namespace framewatch::drivers {

/// Whether all of an HDF5 file, which a MATLAB file of level 7.3 is, lies in it: no link, no data
/// set and no virtual one makes the library open another file. False also when it cannot be read.
/// Turns the library's own messages off.
bool hdf5_is_of_one_file(const std::string& path);

}  // namespace framewatch::drivers

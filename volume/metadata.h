// Numbers added to the metadata of a .vdb that is there already. Knows no OpenVDB to its users.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace nephele {

/// Writes the file anew with these numbers, one or three a name, among the file's metadata, in the place of
/// what they held before; grids and all other metadata stay as they are. Whole or not at all. Throws
/// InputError for a file that cannot be read, WorldError for one that cannot be written.
void addMetadata(const std::string& path, const std::map<std::string, std::vector<double>>& numbers);

}  // namespace nephele

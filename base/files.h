// Files that appear whole or not at all, and what a crash left behind. Depends on base alone.
#pragma once

#include <functional>
#include <string>

namespace nephele {

/// Calls `write` with a temporary path in the folder of `path` (named `.NAME.PID.partial`), flushes it to the
/// disk, then renames it to `path`. Where `write` throws, the temporary file is removed and the exception
/// goes on. Throws WorldError where the folder cannot be written.
void writeWhole(const std::string& path, const std::function<void(const std::string& temporary)>& write);

/// The same for a file of text.
void writeText(const std::string& path, const std::string& text);

/// Throws WorldError where no file can be made in the folder of `path`: asked before long work whose result
/// goes there.
void requireWritable(const std::string& path);

/// Removes `.*.partial` files in `folder` whose writing process is no longer alive. Returns how many.
int removeLeftovers(const std::string& folder);

/// The whole file as bytes. A missing file is an InputError, a failing read a WorldError.
std::string readWhole(const std::string& path);

}  // namespace nephele

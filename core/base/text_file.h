#pragma once

#include <string>
#include <string_view>

namespace vernier {

/// Writes a file beside `path` and renames it, so that `path` is never half-written. Throws Error(output).
void write_text_file(const std::string& path, std::string_view text);

/// Throws Error(output) unless a file can be written at `path`; called before long work, and leaves nothing
/// behind.
void check_writable_text_file(const std::string& path);

}  // namespace vernier

#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace vernier {

/// Writes a file beside `path` and renames it, so that `path` is never half-written; through a symbolic link,
/// beside what it points to. Devices and pipes are written into. Throws Error(output).
void write_text_file(const std::string& path, std::string_view text);

/// The same with bytes that lie in several places, one after the other; and they are on the disk before the
/// name is given, so that even a loss of power leaves the old file or the new one.
void write_file_safely(const std::string& path, std::span<const std::span<const std::byte>> parts);

/// Throws Error(output) unless a file can be written at `path`; called before long work, and leaves nothing
/// behind.
void check_writable_text_file(const std::string& path);

}  // namespace vernier

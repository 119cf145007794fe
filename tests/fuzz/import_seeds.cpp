// SPDX-License-Identifier: Apache-2.0
// import_seeds FOLDER: writes what import_fuzz begins with, and the words of its JSON as a dictionary,
// FOLDER.words.

#include <filesystem>
#include <fstream>
#include <iostream>
#include <set>

#include "tests/scene/seed_files.h"

namespace {

using nlohmann::json;

/// All names of properties, and all values that are words.
void collect(const json& tree, std::set<std::string>& words) {
  if (tree.is_string() && tree.get<std::string>().size() < 60) words.insert(tree.dump());
  if (!tree.is_structured()) return;
  for (const auto& [name, part] : tree.items()) {
    if (tree.is_object()) words.insert(json(name).dump());
    collect(part, words);
  }
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) {
    std::cerr << "usage: import_seeds FOLDER\n";
    return 2;
  }
  const std::filesystem::path folder = arguments[1];
  std::filesystem::create_directories(folder);
  std::set<std::string> words;
  for (const auto& [name, file] : vernier::test::seed_files()) {
    std::ofstream(folder / (name + ".glb"), std::ios::binary) << file.glb();
    collect(file.json, words);
  }
  std::ofstream dictionary(folder.string() + ".words");
  // A word is a JSON string, and libFuzzer wants one with its quotes escaped.
  for (const std::string& word : words) dictionary << json(word).dump() << '\n';
  return dictionary.flush() ? 0 : 1;
}

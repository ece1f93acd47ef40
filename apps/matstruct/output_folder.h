// The results of a run appear in their folder all together or not at all.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace matstruct::tool {

/// Collects files in a hidden staging folder inside the output folder. Unless commit() succeeds, the destructor removes
/// whatever was written, and the output folder too if it was made here.
class OutputFolder {
 public:
  /// Makes the folders, so that an output that cannot be written is refused before the work. Throws Error.
  explicit OutputFolder(const std::filesystem::path& folder);
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  /// Where to write the file `name` until commit().
  std::filesystem::path staged(const std::string& name);
  /// Moves the staged files to their place, replacing older ones. Throws Error, and then none of them is left.
  void commit();

 private:
  void remove_made_folders() noexcept;

  std::filesystem::path folder_;
  std::filesystem::path staging_;
  std::filesystem::path first_made_;  ///< topmost folder that did not exist before, may be empty
  std::vector<std::string> names_;
  bool committed_ = false;
};

}  // namespace matstruct::tool

#include "output_folder.h"

#include <cerrno>
#include <cstring>
#include <utility>

#include <fmt/format.h>
#include <stdlib.h>

#include <matstruct/error.h>

namespace matstruct::tool {

namespace fs = std::filesystem;

namespace {

/// The topmost part of `folder` that does not exist; empty if all of it does.
fs::path first_missing(fs::path folder) {
  fs::path missing;
  std::error_code ignored;
  while (!folder.empty() && !fs::exists(folder, ignored)) {
    missing = folder;
    folder = folder.parent_path();
  }
  return missing;
}

}  // namespace

OutputFolder::OutputFolder(const fs::path& folder) : folder_(fs::absolute(folder).lexically_normal()) {
  if (!folder_.has_filename()) folder_ = folder_.parent_path();
  first_made_ = first_missing(folder_);
  std::error_code failure;
  fs::create_directories(folder_, failure);
  if (failure || !fs::is_directory(folder_)) {
    remove_made_folders();
    throw Error(fmt::format("{}: the output folder cannot be made ({}); give another one with -o.", folder.string(),
                            failure ? failure.message() : "a file of this name is in the way"));
  }
  std::string pattern = (folder_ / ".matstruct-XXXXXX").string();
  if (!mkdtemp(pattern.data())) {
    const std::string reason = std::strerror(errno);
    remove_made_folders();
    throw Error(fmt::format("{}: cannot write into the output folder ({}); give another one with -o.", folder.string(),
                            reason));
  }
  staging_ = pattern;
}

OutputFolder::~OutputFolder() {
  std::error_code ignored;
  fs::remove_all(staging_, ignored);
  if (!committed_) remove_made_folders();
}

void OutputFolder::remove_made_folders() noexcept {
  std::error_code failure;
  if (first_made_.empty()) return;
  // remove() refuses folders that are not empty: somebody else may have put files there meanwhile.
  for (fs::path made = folder_; fs::remove(made, failure) && made != first_made_;) made = made.parent_path();
}

fs::path OutputFolder::staged(const std::string& name) {
  names_.push_back(name);
  return staging_ / name;
}

void OutputFolder::commit() {
  for (std::size_t i = 0; i < names_.size(); ++i) {
    std::error_code failure;
    fs::rename(staging_ / names_[i], folder_ / names_[i], failure);
    if (!failure) continue;
    std::error_code ignored;
    for (std::size_t done = 0; done < i; ++done) fs::remove(folder_ / names_[done], ignored);
    throw Error(fmt::format("{}: cannot be written ({}).", (folder_ / names_[i]).string(), failure.message()));
  }
  committed_ = true;
}

}  // namespace matstruct::tool

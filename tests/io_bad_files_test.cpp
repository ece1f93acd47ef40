// Files that are wrong: each is refused by one sentence that says what, where and what to do; nothing else happens.
#include <nlohmann/json.hpp>

#include <gtest/gtest.h>

#include <matstruct/io.h>

#include "base/random.h"
#include "io_testing.h"

namespace matstruct {
namespace {

using testing::bytes_of;
using testing::error_of;
using testing::TempFolder;

class BadFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!testing::make_files(folder_.path())) GTEST_SKIP() << "needs python3";
    manifest_ = nlohmann::json::parse(bytes_of(folder_ / "manifest.json"));
  }
  TempFolder folder_;
  nlohmann::json manifest_;
};

void expect_one_sentence(const std::string& message, const std::string& file) {
  EXPECT_EQ(message.substr(0, file.size()), file) << message;
  EXPECT_NE(message.find("; "), std::string::npos) << "no advice: " << message;
  EXPECT_EQ(message.back(), '.') << message;
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  for (const char c : message) EXPECT_TRUE(c >= ' ' && c <= '~') << message;
}

TEST_F(BadFiles, AreRefusedByOneSentenceThatSaysWhatAndWhere) {
  int refused = 0;
  for (const auto& entry : manifest_) {
    const std::string file = (folder_ / entry.at("file").get<std::string>()).string();
    const std::string defect = entry.at("defect");
    if (entry.at("stage") == "cad") continue;  // the mesher's business
    if (entry.at("stage") != "read" || entry.at("expect") == "accepted") {
      EXPECT_EQ(error_of([&] { testing::expect_valid(read_model(file)); }), "") << defect;
      continue;
    }
    ++refused;
    const std::string message = error_of([&] { read_model(file); });
    ASSERT_FALSE(message.empty()) << file << " was accepted: " << defect;
    expect_one_sentence(message, file);
    for (const std::string word : entry.at("words"))
      EXPECT_NE(testing::lower(message).find(testing::lower(word)), std::string::npos)
          << "'" << word << "' is not in: " << message;
  }
  EXPECT_GE(refused, 100);
}

/// Every good file of the generator, by the parser for it.
class Seeds : public ::testing::Test {
 protected:
  using Check = void (*)(std::string_view);

  void SetUp() override {
    if (!testing::make_files(folder_.path(), "--seeds")) GTEST_SKIP() << "needs python3";
  }

  template <auto kParse>
  static void parse(std::string_view bytes) {
    testing::expect_valid(kParse(bytes, "f"));
  }
  static void parse_medial(std::string_view bytes) { parse_ma(bytes, "f"); }

  /// Calls action(bytes, check) on each seed; check(bytes) throws Error or accepts a valid model.
  template <class Action>
  void for_each_seed(Action action) {
    const std::array<std::pair<const char*, Check>, 9> kinds{{{"msh", parse<parse_msh>},
                                                              {"medit", parse<parse_medit>},
                                                              {"vtk", parse<parse_vtk>},
                                                              {"vtu", parse<parse_vtu>},
                                                              {"stl", parse<parse_stl>},
                                                              {"obj", parse<parse_obj>},
                                                              {"off", parse<parse_off>},
                                                              {"ply", parse<parse_ply>},
                                                              {"ma", parse_medial}}};
    for (const auto& [kind, check] : kinds)
      for (const auto& entry : std::filesystem::directory_iterator(folder_ / kind))
        action(entry.path().string(), bytes_of(entry.path()), check);
  }
  TempFolder folder_;
};

TEST_F(Seeds, CutShortAnywhereTheyAreRefusedOrStillValid) {
  for_each_seed([](const std::string& file, const std::string& bytes, Check check) {
    for (std::size_t n = 0; n < bytes.size(); ++n) {
      // A copy of its own, so that the address sanitizer sees a read past the end.
      const std::vector<char> part(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(n));
      const std::string message = error_of([&] { check({part.data(), part.size()}); });
      const bool binary = bytes.find('\0') != std::string::npos;
      const bool only_blanks_cut = bytes.find_first_not_of(" \n", n) == std::string::npos;
      EXPECT_TRUE(!message.empty() || !binary || only_blanks_cut) << file << " cut to " << n;
    }
  });
}

TEST_F(Seeds, WithChangedBytesTheyAreRefusedOrStillValid) {
  constexpr int kTrials = 2000;
  std::uint64_t stage = 0;
  for_each_seed([&](const std::string&, const std::string& bytes, Check check) {
    ++stage;
    for (std::uint64_t trial = 0; trial < kTrials; ++trial) {
      KeyedRandom random(1, stage, trial);
      std::string changed = bytes;
      for (std::uint64_t k = 0; k <= trial % 3; ++k)
        changed[random.next() % changed.size()] = static_cast<char>(random.next() % 256);
      error_of([&] { check(changed); });  // whatever is thrown other than Error fails the test
    }
  });
}

TEST(ModelsBad, OtherPeoplesFilesAreRefusedOrRead) {
  const std::filesystem::path folder = std::filesystem::path(MATSTRUCT_SHARED_DATA) / "bad";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "needs the shared models";
  struct Case {
    const char* file;
    const char* words;  ///< of the message; empty if the file is read
  };
  for (const auto& [file, words] : std::initializer_list<Case>{{"2triangles.off", ""},
                                                               {"beetle.off", ""},
                                                               {"camel_b.obj", ""},
                                                               {"comments.off", ""},
                                                               {"empty.obj", "no vertices"},
                                                               {"empty.ply", "no vertices"},
                                                               {"empty.stl", "no vertices"},
                                                               {"face_in_group_name.obj", "point cloud"},
                                                               {"grid.off", ""},
                                                               {"insulated.msh", ""},
                                                               {"intersection_quads.off", ""},
                                                               {"jacked.obj", ""},
                                                               {"lilium.obj", ""},
                                                               {"multibody.stl", ""},
                                                               {"nancolor.obj", ""},
                                                               {"negative_indices.obj", ""},
                                                               {"obj_empty.obj", "no vertices"},
                                                               {"notenoughindices.obj", "line 9: face 1 has 2 corners"},
                                                               {"obj_points.obj", "point cloud"},
                                                               {"obj_with_no_face_in_chunk.obj", ""},
                                                               {"ply_empty_ascii.ply", "no vertices"},
                                                               {"ply_empty_bin.ply", "no vertices"},
                                                               {"ply_empty_header.ply", "no vertices"},
                                                               {"ply_points_ascii.ply", "point cloud"},
                                                               {"soup.stl", ""},
                                                               {"stl_empty_ascii.stl", "no vertices"},
                                                               {"stl_empty_bin.stl", "no vertices"}}) {
    const std::string message = error_of([&] { testing::expect_valid(read_model(folder / file)); });
    EXPECT_EQ(message.empty(), *words == '\0') << message;
    EXPECT_NE(message.find(words), std::string::npos) << message;
    if (!message.empty()) expect_one_sentence(message, (folder / file).string());
  }
}

TEST(ModelsGood, EveryModelIsRead) {
  const std::filesystem::path folder = MATSTRUCT_SHARED_DATA;
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "needs the shared models";
  for (const auto& entry : std::filesystem::directory_iterator(folder / "tet"))
    EXPECT_EQ(error_of([&] { testing::expect_valid(read_tet_mesh(entry.path())); }), "");
  for (const auto& entry : std::filesystem::directory_iterator(folder / "surface"))
    EXPECT_EQ(error_of([&] { testing::expect_valid(read_surface(entry.path())); }), "");
}

}  // namespace
}  // namespace matstruct

#include <charconv>
#include <fstream>
#include <sstream>
#include <string>

#include <fmt/format.h>

#include <matstruct/error.h>
#include <matstruct/io.h>
#include <matstruct/solid.h>

namespace matstruct {

std::vector<Edge> read_sharp_lines(const std::filesystem::path& file, Index vertices) {
  check_readable(file);
  std::ifstream in(file);
  std::vector<Edge> edges;
  std::string text;
  for (int line = 1; std::getline(in, text); ++line) {
    std::istringstream words(text.substr(0, text.find('#')));
    Index previous = kInvalid, corners = 0;
    for (std::string word; words >> word; ++corners) {
      Index id = kInvalid;
      const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), id);
      if (error != std::errc() || end != word.data() + word.size() || id < 0 || id >= vertices)
        throw Error(fmt::format("{}: line {}: '{}' is no vertex; the model's vertices are 0 to {}.", file.string(),
                                line, word, vertices - 1));
      if (corners > 0 && id != previous) edges.push_back({previous, id});
      previous = id;
    }
    if (corners == 1)
      throw Error(fmt::format("{}: line {}: a sharp line needs two vertices; this has one.", file.string(), line));
  }
  return edges;
}

}  // namespace matstruct

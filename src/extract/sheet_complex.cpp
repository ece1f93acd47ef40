// T. K. Dey, H. Edelsbrunner, S. Guha and D. V. Nekhayev, "Topology preserving edge contraction", 1999: contracting an
// edge of a 2-complex gives a homeomorphic one if the links of its ends meet in the link of the edge, in the complex
// and in that of its curves (there with a cone over it). A vertex inside a sheet is in no curve, so that the first
// condition remains. For one inside a curve the second says that the curve does not close to fewer than three edges.
#include "extract/sheet_complex.h"

#include <algorithm>
#include <iterator>

#include "base/index.h"

namespace matstruct {

namespace {

void erase_value(std::vector<Index>& values, Index value) {
  values.erase(std::remove(values.begin(), values.end(), value), values.end());
}

bool contains(const std::vector<Index>& values, Index value) {
  return std::find(values.begin(), values.end(), value) != values.end();
}

bool has_corner(const Triangle& t, Index v) {
  return t[0] == v || t[1] == v || t[2] == v;
}

}  // namespace

SheetComplex::SheetComplex(const StratifiedMesh& stratified)
    : vertex_alive_(stratified.mesh.centers.size(), true),
      freedom_(stratified.freedom),
      faces_of_(stratified.mesh.centers.size()),
      curve_(stratified.mesh.centers.size()) {
  for (std::size_t f = 0; f < stratified.mesh.faces.size(); ++f)
    add_face(stratified.mesh.faces[f], stratified.sheet_of_face[f]);
  for (const auto& [a, b] : stratified.curve_edges) {
    curve_[uz(a)].push_back(b);
    curve_[uz(b)].push_back(a);
  }
}

std::vector<Index> SheetComplex::neighbors(Index v) const {
  std::vector<Index> result = curve_[uz(v)];
  for (const Index f : faces_of_[uz(v)])
    for (const Index w : corners_[uz(f)])
      if (w != v) result.push_back(w);
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

std::vector<Index> SheetComplex::faces_of_edge(Index a, Index b) const {
  std::vector<Index> result;
  for (const Index f : faces_of_[uz(a)])
    if (has_corner(corners_[uz(f)], b)) result.push_back(f);
  return result;
}

bool SheetComplex::is_edge(Index a, Index b) const {
  return is_curve_edge(a, b) || std::any_of(faces_of_[uz(a)].begin(), faces_of_[uz(a)].end(),
                                            [&](Index f) { return has_corner(corners_[uz(f)], b); });
}

bool SheetComplex::is_curve_edge(Index a, Index b) const {
  return contains(curve_[uz(a)], b);
}

std::vector<Triangle> SheetComplex::triangles() const {
  std::vector<Triangle> result;
  for (Index f = 0; f < faces(); ++f)
    if (face_alive(f)) {
      result.push_back(corners(f));
      std::sort(result.back().begin(), result.back().end());
    }
  std::sort(result.begin(), result.end());
  return result;
}

std::vector<Edge> SheetComplex::edges() const {
  std::vector<Edge> result;
  for (const auto& [a, b, c] : triangles()) result.insert(result.end(), {Edge{a, b}, Edge{a, c}, Edge{b, c}});
  for (Index a = 0; a < vertices(); ++a)
    for (const Index b : curve_[uz(a)])
      if (a < b) result.push_back({a, b});
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

void SheetComplex::add_face(const Triangle& corners, Index sheet) {
  const Index f = faces();
  corners_.push_back(corners);
  sheet_.push_back(sheet);
  face_alive_.push_back(true);
  for (const Index v : corners) faces_of_[uz(v)].push_back(f);
}

void SheetComplex::remove_face(Index f) {
  face_alive_[uz(f)] = false;
  for (const Index v : corners_[uz(f)]) erase_value(faces_of_[uz(v)], f);
}

void SheetComplex::replace_corner(Index f, Index from, Index to) {
  for (Index& v : corners_[uz(f)])
    if (v == from) v = to;
  erase_value(faces_of_[uz(from)], f);
  faces_of_[uz(to)].push_back(f);
}

Index SheetComplex::other_corner(const Triangle& t, Index a, Index b) {
  for (const Index v : t)
    if (v != a && v != b) return v;
  return kInvalid;
}

bool SheetComplex::can_collapse(Index gone, Index kept) const {
  if (freedom(gone) == Freedom::kFixed) return false;
  const bool along_curve = is_curve_edge(gone, kept);
  if (along_curve != (freedom(gone) == Freedom::kCurve)) return false;
  if (along_curve)
    for (const Index w : curve_[uz(gone)])
      if (w != kept && (w == gone || is_edge(w, kept))) return false;

  const std::vector<Index> faces = faces_of_edge(gone, kept);
  std::vector<Index> opposite;
  for (const Index f : faces) opposite.push_back(other_corner(corners(f), gone, kept));
  std::sort(opposite.begin(), opposite.end());
  const std::vector<Index> around_gone = neighbors(gone), around_kept = neighbors(kept);
  std::vector<Index> common;
  std::set_intersection(around_gone.begin(), around_gone.end(), around_kept.begin(), around_kept.end(),
                        std::back_inserter(common));
  if (common != opposite) return false;
  // No edge may be in both links.
  for (const Index f : faces_of(gone)) {
    if (has_corner(corners(f), kept)) continue;
    const auto& [a, b, c] = corners(f);
    const Index v = a == gone ? b : a, w = c == gone ? b : c;
    for (const Index g : faces_of(kept))
      if (has_corner(corners(g), v) && has_corner(corners(g), w)) return false;
  }
  return true;
}

void SheetComplex::collapse(Index gone, Index kept) {
  for (const Index f : faces_of_edge(gone, kept)) remove_face(f);
  const std::vector<Index> moved = faces_of_[uz(gone)];
  for (const Index f : moved) replace_corner(f, gone, kept);
  for (const Index w : curve_[uz(gone)]) {
    erase_value(curve_[uz(w)], gone);
    if (w == kept) continue;
    curve_[uz(w)].push_back(kept);
    curve_[uz(kept)].push_back(w);
  }
  curve_[uz(gone)].clear();
  vertex_alive_[uz(gone)] = false;
}

bool SheetComplex::can_flip(Index a, Index b) const {
  if (is_curve_edge(a, b)) return false;
  const std::vector<Index> faces = faces_of_edge(a, b);
  if (faces.size() != 2) return false;
  const Index c = other_corner(corners(faces[0]), a, b), d = other_corner(corners(faces[1]), a, b);
  return c != d && !is_edge(c, d);
}

void SheetComplex::flip(Index a, Index b) {
  const std::vector<Index> faces = faces_of_edge(a, b);
  const Index c = other_corner(corners(faces[0]), a, b), d = other_corner(corners(faces[1]), a, b);
  replace_corner(faces[0], b, d);
  replace_corner(faces[1], a, c);
}

Index SheetComplex::split(Index a, Index b) {
  const bool on_curve = is_curve_edge(a, b);
  const Index middle = vertices();
  vertex_alive_.push_back(true);
  freedom_.push_back(on_curve ? Freedom::kCurve : Freedom::kSheet);
  faces_of_.emplace_back();
  curve_.emplace_back();
  for (const Index f : faces_of_edge(a, b)) {
    Triangle second = corners(f);
    std::replace(second.begin(), second.end(), a, middle);
    replace_corner(f, b, middle);
    add_face(second, sheet(f));
  }
  if (on_curve) {
    std::replace(curve_[uz(a)].begin(), curve_[uz(a)].end(), b, middle);
    std::replace(curve_[uz(b)].begin(), curve_[uz(b)].end(), a, middle);
    curve_[uz(middle)] = {a, b};
  }
  return middle;
}

}  // namespace matstruct

// Where a sheet ends freely, as on the axis of a fillet, its last spheres may or may not meet those of another sheet.
// If they do, a seam of an edge or two runs on from where the sheets part, or a sheet of a triangle or two is cut off;
// near the tip of a sheet, where its walls are nearer to each other than the spheres, they may touch along an edge.
// None of this is the solid's: another triangulation of its surface has none of it, or has it elsewhere.
#include "extract/small_strata.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <map>
#include <optional>
#include <set>

#include <matstruct/strata.h>

#include "base/index.h"
#include "extract/compact.h"
#include "geometry/primitives.h"

namespace matstruct {

namespace {

// A sheet is small up to this many squares of the spacing; a seam up to so many spacings if it hangs on a junction, and
// if it lies in the midst of a sheet; a whisker.
constexpr double kSmallSheet = 2, kSmallSeam = 1, kSmallLoneSeam = 1.5, kSmallWhisker = 4;
// What a whisker may stick out of the rest, in spacings: as far as a sheet's ragged end does.
constexpr double kWhiskerCover = 0.3;
// Spheres of seams and junctions have at least so many contacts.
constexpr Index kContactsOfSeam = 3, kContactsOfJunction = 4;
// A sphere of no seam on one is merged into a neighbour that is at most so many spacings away.
constexpr double kFalseSeam = 0.5;
// A sheet between seams that run side by side, without a border of its own, is small up to this many squares.
constexpr double kSliver = 0.03;
// Seams of up to this share of the spacing are contracted if they are shorter than the resolution.
constexpr double kTinySeam = 0.02;

std::array<Edge, 3> edges_of(const Triangle& t) {
  return {Edge{t[0], t[1]}, Edge{t[0], t[2]}, Edge{t[1], t[2]}};
}

bool has(const Triangle& t, Index v) {
  return std::find(t.begin(), t.end(), v) != t.end();
}

Index apex_of(const Triangle& t, Index a, Index b) {
  return t[0] + t[1] + t[2] - a - b;
}

/// Simplices that elementary collapses take away.
struct Removal {
  std::set<Index> faces, vertices;
  std::set<Edge> edges;
};

/// The simplices of a mesh with their incidences, under edits. Faces keep their ids.
class Complex {
 public:
  Complex(const MedialMesh& mesh, const std::vector<Edge>& fixed_edges, double cover);

  /// Faces at a vertex or an edge that are there, ascending at a vertex.
  const std::vector<Index>& faces_at(Index v) const { return faces_at_[uz(v)]; }
  std::vector<Index> faces_of(const Edge& e) const;
  bool has_face(const Triangle& t) const;
  const std::vector<Index>& neighbors(Index v) const { return neighbors_[uz(v)]; }
  const Triangle& face(Index f) const { return faces_[uz(f)]; }
  bool is_fixed(Index v) const { return fixed_[uz(v)]; }
  /// Whether an edit has changed what is around a vertex: what was traced there before is not so any more.
  bool is_touched(Index v) const { return touched_[uz(v)]; }

  /// What collapses remove together with the faces, if they can all be removed, nothing bare is left of them, and the
  /// faces around cover them.
  std::optional<Removal> collapse(const std::vector<Index>& faces) const;
  void apply(const Removal& removal);
  /// Merges a vertex into its neighbour, if the link condition holds and the result covers it. Returns whether it did.
  bool contract(Index gone, Index kept);
  /// How far a vertex's ball sticks out of the faces at another one.
  double excess(Index v, Index root) const;
  void remove_edge(const Edge& e);
  /// The edges and faces that are there, sorted.
  void store(MedialMesh& mesh) const;

 private:
  Ball ball(Index v) const { return {mesh_.centers[uz(v)], mesh_.radii[uz(v)]}; }
  bool is_fixed(const Edge& e) const { return std::binary_search(fixed_edges_.begin(), fixed_edges_.end(), e); }
  bool link_condition(Index a, Index b) const;
  bool leaves_bare_edges(Index a, Index b) const;
  bool lies_on_line(const Triangle& t) const;
  double excess(const Ball& b, const std::vector<Triangle>& over) const;
  bool covered(const Ball& b, const std::vector<Triangle>& by) const;
  bool covered(const Removal& removal) const;
  void remove_face(Index f);

  const MedialMesh& mesh_;
  const std::vector<Edge>& fixed_edges_;
  double cover_;
  std::vector<bool> fixed_, touched_;  // per vertex
  std::vector<Triangle> faces_;
  std::vector<std::vector<Index>> faces_at_, neighbors_;  // per vertex, ascending
};

void insert_sorted(std::vector<Index>& list, Index item) {
  const auto at = std::lower_bound(list.begin(), list.end(), item);
  if (at == list.end() || *at != item) list.insert(at, item);
}

Complex::Complex(const MedialMesh& mesh, const std::vector<Edge>& fixed_edges, double cover)
    : mesh_(mesh),
      fixed_edges_(fixed_edges),
      cover_(cover),
      fixed_(mesh.centers.size(), false),
      touched_(mesh.centers.size(), false),
      faces_(mesh.faces),
      faces_at_(mesh.centers.size()),
      neighbors_(mesh.centers.size()) {
  for (const Edge& e : fixed_edges)
    for (const Index v : e) fixed_[uz(v)] = true;
  for (Index v = 0; v < count(mesh.centers); ++v)
    if (mesh.types[uz(v)] == SphereType::kSharpEdge || mesh.types[uz(v)] == SphereType::kCorner) fixed_[uz(v)] = true;
  for (const auto& [a, b] : mesh.edges) {
    neighbors_[uz(a)].push_back(b);
    neighbors_[uz(b)].push_back(a);
  }
  for (std::vector<Index>& list : neighbors_) std::sort(list.begin(), list.end());
  for (Index f = 0; f < count(faces_); ++f)
    for (const Index v : face(f)) faces_at_[uz(v)].push_back(f);
}

std::vector<Index> Complex::faces_of(const Edge& e) const {
  std::vector<Index> result;
  for (const Index f : faces_at(e[0]))
    if (has(face(f), e[1])) result.push_back(f);
  return result;
}

bool Complex::has_face(const Triangle& t) const {
  return std::any_of(faces_at(t[0]).begin(), faces_at(t[0]).end(),
                     [&](Index f) { return has(face(f), t[1]) && has(face(f), t[2]); });
}

void Complex::remove_face(Index f) {
  for (const Index v : face(f)) {
    std::erase(faces_at_[uz(v)], f);
    touched_[uz(v)] = true;
  }
}

void Complex::remove_edge(const Edge& e) {
  std::erase(neighbors_[uz(e[0])], e[1]);
  std::erase(neighbors_[uz(e[1])], e[0]);
  touched_[uz(e[0])] = touched_[uz(e[1])] = true;
}

void Complex::store(MedialMesh& mesh) const {
  mesh.edges.clear();
  mesh.faces.clear();
  for (Index v = 0; v < count(neighbors_); ++v) {
    for (const Index w : neighbors_[uz(v)])
      if (v < w) mesh.edges.push_back({v, w});
    for (const Index f : faces_at(v))
      if (face(f)[0] == v) mesh.faces.push_back(face(f));
  }
  std::sort(mesh.faces.begin(), mesh.faces.end());
}

std::optional<Removal> Complex::collapse(const std::vector<Index>& faces) const {
  std::map<Edge, std::size_t> degree;
  for (const Index f : faces)
    for (const Edge& e : edges_of(face(f))) degree[e] = faces_of(e).size();
  Removal removal;
  const auto free_edge = [&](Index f) -> std::optional<Edge> {
    for (const Edge& e : edges_of(face(f)))
      if (degree[e] == 1 && !is_fixed(e)) return e;
    return std::nullopt;
  };
  for (bool changed = true; changed;) {
    changed = false;
    for (const Index f : faces) {
      const std::optional<Edge> free = removal.faces.contains(f) ? std::nullopt : free_edge(f);
      if (!free) continue;
      removal.faces.insert(f);
      removal.edges.insert(*free);
      for (const Edge& e : edges_of(face(f))) --degree[e];
      changed = true;
    }
  }
  if (removal.faces.size() < faces.size()) return std::nullopt;
  // Of what is bare now, edges that end nowhere go with their ends.
  std::set<Edge> bare;
  for (const auto& [e, n] : degree)
    if (n == 0 && !removal.edges.contains(e)) bare.insert(e);
  const auto ends = [&](Index v) {
    return !fixed_[uz(v)] && std::count_if(neighbors_[uz(v)].begin(), neighbors_[uz(v)].end(),
                                           [&](Index w) { return !removal.edges.contains(ordered_edge(v, w)); }) == 1;
  };
  for (bool changed = true; changed;) {
    changed = false;
    for (const Edge& e : std::set<Edge>(bare)) {
      const Index end = ends(e[0]) ? e[0] : ends(e[1]) ? e[1] : kInvalid;
      if (end == kInvalid) continue;
      removal.edges.insert(e);
      removal.vertices.insert(end);
      bare.erase(e);
      changed = true;
    }
  }
  if (!bare.empty() || !covered(removal)) return std::nullopt;
  return removal;
}

double Complex::excess(const Ball& b, const std::vector<Triangle>& over) const {
  double least = std::numeric_limits<double>::infinity();
  for (const Triangle& t : over) {
    const Ball p = ball(t[0]), q = ball(t[1]), r = ball(t[2]);
    const PrimitiveHit hit = closest_on_triangle(b.center, p.center, q.center, r.center);
    least = std::min(least, hit.distance + b.radius - ball_at(p, q, r, hit.weights).radius);
  }
  return least;
}

double Complex::excess(Index v, Index root) const {
  std::vector<Triangle> around;
  for (const Index f : faces_at(root)) around.push_back(face(f));
  return excess(ball(v), around);
}

bool Complex::covered(const Ball& b, const std::vector<Triangle>& by) const {
  return excess(b, by) <= cover_;
}

bool Complex::covered(const Removal& removal) const {
  std::set<Index> around;
  for (const Index f : removal.faces)
    for (const Index v : face(f)) around.insert(faces_at(v).begin(), faces_at(v).end());
  std::vector<Triangle> rest;
  for (const Index f : around)
    if (!removal.faces.contains(f)) rest.push_back(face(f));
  const auto mean = [&](Index a, Index b, Index c, const std::array<double, 3>& weights) {
    return ball_at(ball(a), ball(b), ball(c), weights);
  };
  return std::all_of(removal.vertices.begin(), removal.vertices.end(),
                     [&](Index v) { return covered(ball(v), rest); }) &&
         std::all_of(removal.edges.begin(), removal.edges.end(),
                     [&](const Edge& e) {
                       return covered(mean(e[0], e[1], e[1], {0.5, 0.5, 0}), rest);
                     }) &&
         std::all_of(removal.faces.begin(), removal.faces.end(), [&](Index f) {
           const Triangle& t = face(f);
           return covered(mean(t[0], t[1], t[2], {1.0 / 3, 1.0 / 3, 1.0 / 3}), rest);
         });
}

void Complex::apply(const Removal& removal) {
  for (const Index f : removal.faces) remove_face(f);
  for (const Edge& e : removal.edges) remove_edge(e);
}

// Whether two edges of a face are neighbours on one sharp line.
bool Complex::lies_on_line(const Triangle& t) const {
  return std::any_of(t.begin(), t.end(), [&](Index v) {
    if (mesh_.types[uz(v)] != SphereType::kSharpEdge) return false;
    return std::all_of(t.begin(), t.end(), [&](Index w) { return w == v || is_fixed(ordered_edge(v, w)); });
  });
}

// Links of a and b meet in the link of their edge and nowhere else.
bool Complex::link_condition(Index a, Index b) const {
  std::vector<Index> apexes, common;
  for (const Index f : faces_of({a, b})) insert_sorted(apexes, apex_of(face(f), a, b));
  std::set_intersection(neighbors_[uz(a)].begin(), neighbors_[uz(a)].end(), neighbors_[uz(b)].begin(),
                        neighbors_[uz(b)].end(), std::back_inserter(common));
  if (common != apexes) return false;
  return std::none_of(faces_at(a).begin(), faces_at(a).end(), [&](Index f) {
    Triangle moved = face(f);
    if (has(moved, b)) return false;
    std::replace(moved.begin(), moved.end(), a, b);
    return has_face(moved);
  });
}

// Whether a face at the edge ab would shrink to an edge of no face.
bool Complex::leaves_bare_edges(Index a, Index b) const {
  const std::vector<Index> faces = faces_of({a, b});
  return std::any_of(faces.begin(), faces.end(), [&](Index f) {
    const Index apex = apex_of(face(f), a, b);
    return faces_of({a, apex}).size() + faces_of({b, apex}).size() == 2;
  });
}

bool Complex::contract(Index gone, Index kept) {
  if (fixed_[uz(gone)] || !link_condition(gone, kept) || leaves_bare_edges(gone, kept)) return false;
  std::vector<Index> stay;
  std::vector<Triangle> moved;
  for (const Index f : faces_at(gone)) {
    Triangle t = face(f);
    if (has(t, kept)) continue;
    std::replace(t.begin(), t.end(), gone, kept);
    std::sort(t.begin(), t.end());
    if (lies_on_line(t)) return false;
    stay.push_back(f);
    moved.push_back(t);
  }
  std::vector<Triangle> star = moved;  // of `kept`, afterwards
  for (const Index f : faces_at(kept))
    if (!has(face(f), gone)) star.push_back(face(f));
  if (!covered(ball(gone), star)) return false;
  for (const Index f : std::vector<Index>(faces_at(gone))) remove_face(f);
  for (const Index v : std::vector<Index>(neighbors_[uz(gone)])) {
    remove_edge(ordered_edge(gone, v));
    if (v == kept) continue;
    insert_sorted(neighbors_[uz(v)], kept);
    insert_sorted(neighbors_[uz(kept)], v);
  }
  for (std::size_t k = 0; k < stay.size(); ++k) {
    faces_[uz(stay[k])] = moved[k];
    for (const Index v : moved[k]) insert_sorted(faces_at_[uz(v)], stay[k]);
  }
  return true;
}

bool is_junction(const Strata& strata, Index v) {
  return std::binary_search(strata.junctions.begin(), strata.junctions.end(), v);
}

// Contracts an edge of a sheet, which reaches no sharp line, at a vertex that is no junction.
bool shrink(const Strata& strata, const std::vector<Index>& faces, Complex& complex) {
  for (const Index f : faces)
    for (const Index v : complex.face(f))
      if (complex.is_fixed(v)) return false;
  for (const Index f : faces)
    for (const Edge& e : edges_of(complex.face(f)))
      for (const auto& [gone, kept] : {std::pair(e[0], e[1]), std::pair(e[1], e[0])})
        if (!is_junction(strata, gone) && complex.contract(gone, kept)) return true;
  return false;
}

// Strata that an edit has touched wait for the next trace. Returns whether there was an edit.
bool drop_sheets(const MedialMesh& mesh, const Strata& strata, double square, Complex& complex) {
  std::vector<std::vector<Index>> faces(uz(strata.sheets));
  std::vector<double> area(uz(strata.sheets), 0);
  for (Index f = 0; f < count(mesh.faces); ++f) {
    const auto& [a, b, c] = mesh.faces[uz(f)];
    faces[uz(strata.sheet_of_face[uz(f)])].push_back(f);
    area[uz(strata.sheet_of_face[uz(f)])] +=
        triangle_area(mesh.centers[uz(a)], mesh.centers[uz(b)], mesh.centers[uz(c)]);
  }
  const auto touched = [&](const std::vector<Index>& sheet) {
    return std::any_of(sheet.begin(), sheet.end(), [&](Index f) {
      return std::any_of(mesh.faces[uz(f)].begin(), mesh.faces[uz(f)].end(),
                         [&](Index v) { return complex.is_touched(v); });
    });
  };
  bool changed = false;
  for (std::size_t s = 0; s < faces.size(); ++s) {
    if (area[s] > kSmallSheet * square || touched(faces[s])) continue;
    if (const auto removal = complex.collapse(faces[s])) {
      complex.apply(*removal);
      changed = true;
    } else if (area[s] <= kSliver * square && shrink(strata, faces[s], complex)) {
      changed = true;
    }
  }
  return changed;
}

// The faces around `end` from one at the edge to `next` up to a free edge, if they come to one without a seam between.
std::vector<Index> fan_to_border(const Complex& complex, Index end, Index next, Index face) {
  std::vector<Index> fan;
  Index across = next;
  while (true) {
    fan.push_back(face);
    across = apex_of(complex.face(face), end, across);
    const std::vector<Index> faces = complex.faces_of({end, across});
    if (faces.size() == 1) return fan;
    if (faces.size() > 2) return {};
    face = faces[0] == face ? faces[1] : faces[0];
  }
}

// Contracts an edge of a seam, or what is in its way: a vertex that with both ends and a third one spans three faces of
// a tetrahedron but not the fourth, which contracting it into the third one makes.
bool contract_seam_edge(Index end, Index next, Complex& complex) {
  if (complex.contract(end, next)) return true;
  for (const Index f : complex.faces_of({end, next})) {
    const Index middle = apex_of(complex.face(f), end, next);
    for (const Index g : complex.faces_of({end, middle})) {
      const Index third = apex_of(complex.face(g), end, middle);
      if (third != next && complex.has_face({next, middle, third}) && !complex.has_face({end, next, third}) &&
          complex.contract(middle, third))
        return true;
    }
  }
  return false;
}

// Shortens a seam by its edge at the free end `end`: what hangs on it there goes, or the edge is contracted.
bool shorten(Index end, Index next, bool hangs, Complex& complex) {
  if (hangs) {
    const std::vector<Index> faces = complex.faces_of({end, next});
    for (const Index f : faces) {
      const std::vector<Index> fan = fan_to_border(complex, end, next, f);
      const auto removal = fan.empty() ? std::nullopt : complex.collapse(fan);
      if (!removal) continue;
      complex.apply(*removal);
      return true;
    }
  }
  return contract_seam_edge(end, next, complex);
}

// Whether a curve is open, no longer than `shortest`, and as it was traced.
bool is_short(const MedialMesh& mesh, const Curve& curve, double shortest, const Complex& complex) {
  return !curve.closed() && length_of(mesh, curve) <= shortest &&
         std::none_of(curve.vertices.begin(), curve.vertices.end(), [&](Index v) { return complex.is_touched(v); });
}

// As drop_sheets().
bool drop_seams(const MedialMesh& mesh, const Strata& strata, double spacing, Complex& complex) {
  bool changed = false;
  for (const Curve& seam : strata.seams) {
    const std::vector<Index>& v = seam.vertices;
    const bool front = !is_junction(strata, v.front()), back = !is_junction(strata, v.back());
    if (!is_short(mesh, seam, (front && back ? kSmallLoneSeam : kSmallSeam) * spacing, complex)) continue;
    // A sheet may let go of another one where it stays joined to it at the seam's other end.
    const bool hangs = front != back;
    if ((front && shorten(v.front(), v[1], hangs, complex)) ||
        (back && shorten(v.back(), v[v.size() - 2], hangs, complex)))
      changed = true;
  }
  return changed;
}

// Makes one junction of those that seams below the resolution join. As drop_sheets().
bool merge_junctions(const MedialMesh& mesh, const Strata& strata, double longest, Complex& complex) {
  bool changed = false;
  for (const Curve& seam : strata.seams) {
    if (!is_short(mesh, seam, longest, complex)) continue;
    for (std::size_t k = 1; k < seam.vertices.size(); ++k)
      if (contract_seam_edge(seam.vertices[k - 1], seam.vertices[k], complex)) changed = true;
  }
  return changed;
}

// Merges spheres of seams and junctions with too few contacts for those into neighbours. As drop_sheets().
bool drop_false_seams(const MedialMesh& mesh, const Strata& strata, const std::vector<Index>& contacts, double reach,
                      Complex& complex) {
  bool changed = false;
  for (const Curve& seam : strata.seams)
    for (const Index v : seam.vertices) {
      const Index least = is_junction(strata, v) ? kContactsOfJunction : kContactsOfSeam;
      if (contacts[uz(v)] >= least || complex.is_fixed(v) || complex.is_touched(v)) continue;
      std::vector<std::pair<double, Index>> near;
      for (const Index w : complex.neighbors(v)) {
        const double length = distance(mesh.centers[uz(v)], mesh.centers[uz(w)]);
        if (length < reach) near.emplace_back(length, w);
      }
      std::sort(near.begin(), near.end());
      changed = std::any_of(near.begin(), near.end(), [&](const auto& n) { return complex.contract(v, n.second); }) ||
                changed;
    }
  return changed;
}

// Removes curves that end nowhere: edges whose faces thinning has taken all, and those between spheres that touch one
// curved face. As drop_sheets().
bool drop_whiskers(const MedialMesh& mesh, const Strata& strata, const std::vector<std::uint8_t>& faint, double spacing,
                   Complex& complex) {
  bool changed = false;
  for (const Curve& curve : strata.curves) {
    std::vector<Index> v = curve.vertices;
    if (complex.neighbors(v.back()).size() > 1) std::reverse(v.begin(), v.end());
    const Index root = v.front();
    if (complex.neighbors(v.back()).size() != 1 || complex.neighbors(root).size() < 2) continue;
    const auto all = [&](const auto& holds) { return std::all_of(v.begin() + 1, v.end(), holds); };
    if (!all([&](Index w) { return !complex.is_fixed(w) && !complex.is_touched(w); })) continue;
    const auto is_faint = [&](Index w) { return !faint.empty() && faint[uz(w)] != 0; };
    const bool is_covered =
        length_of(mesh, curve) <= kSmallWhisker * spacing && !complex.faces_at(root).empty() &&
        all([&](Index w) { return is_faint(w) || complex.excess(w, root) <= kWhiskerCover * spacing; });
    if (!all(is_faint) && !is_covered) continue;
    for (std::size_t k = 1; k < v.size(); ++k) complex.remove_edge(ordered_edge(v[k - 1], v[k]));
    changed = true;
  }
  return changed;
}

// The vertices of some edge now, or of none before.
std::vector<std::uint8_t> vertices_left(const MedialMesh& mesh, const std::vector<Edge>& edges_before) {
  std::vector<std::uint8_t> left(mesh.centers.size(), 1);
  for (const Edge& e : edges_before) left[uz(e[0])] = left[uz(e[1])] = 0;
  for (const Edge& e : mesh.edges) left[uz(e[0])] = left[uz(e[1])] = 1;
  return left;
}

}  // namespace

std::vector<Index> drop_small_strata(MedialMesh& mesh, const std::vector<Edge>& fixed_edges,
                                     const SmallStrataOptions& options) {
  const std::vector<Edge> edges_before = mesh.edges;
  for (bool changed = true; changed;) {
    const Strata strata = trace_strata(mesh);
    Complex complex(mesh, fixed_edges, options.cover);
    changed = drop_sheets(mesh, strata, options.spacing * options.spacing, complex) ||
              drop_seams(mesh, strata, options.spacing, complex) ||
              merge_junctions(mesh, strata, std::min(options.resolution, kTinySeam * options.spacing), complex) ||
              (!options.contacts.empty() &&
               drop_false_seams(mesh, strata, options.contacts, kFalseSeam * options.spacing, complex)) ||
              drop_whiskers(mesh, strata, options.faint, options.spacing, complex);
    complex.store(mesh);
  }
  return compact(mesh, vertices_left(mesh, edges_before));
}

}  // namespace matstruct

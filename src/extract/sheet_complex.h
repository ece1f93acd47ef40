// A 2-complex of sheets and curves that is edited by splits, collapses and flips which keep its strata.
#pragma once

#include <vector>

#include <matstruct/types.h>

#include "extract/stratified_mesh.h"

namespace matstruct {

/// Vertices and faces keep their ids; what is removed leaves a gap, what is new comes last. An edge is of the curve
/// kind or has two faces of one sheet. Every edit below leaves a complex that is homeomorphic to the one before,
/// stratum by stratum; its precondition is what its can_ function tells.
class SheetComplex {
 public:
  explicit SheetComplex(const StratifiedMesh& stratified);

  Index vertices() const { return static_cast<Index>(faces_of_.size()); }
  Index faces() const { return static_cast<Index>(corners_.size()); }
  bool vertex_alive(Index v) const { return vertex_alive_[static_cast<std::size_t>(v)]; }
  bool face_alive(Index f) const { return face_alive_[static_cast<std::size_t>(f)]; }
  Freedom freedom(Index v) const { return freedom_[static_cast<std::size_t>(v)]; }
  const Triangle& corners(Index f) const { return corners_[static_cast<std::size_t>(f)]; }
  Index sheet(Index f) const { return sheet_[static_cast<std::size_t>(f)]; }
  /// In no particular but a reproducible order.
  const std::vector<Index>& faces_of(Index v) const { return faces_of_[static_cast<std::size_t>(v)]; }
  /// The other ends of the edges of the curve kind.
  const std::vector<Index>& curve_neighbors(Index v) const { return curve_[static_cast<std::size_t>(v)]; }
  /// Ascending.
  std::vector<Index> neighbors(Index v) const;
  std::vector<Index> faces_of_edge(Index a, Index b) const;
  bool is_edge(Index a, Index b) const;
  bool is_curve_edge(Index a, Index b) const;
  /// Edges and faces that are alive, vertices of each ascending, sorted.
  std::vector<Edge> edges() const;
  std::vector<Triangle> triangles() const;

  /// Whether `gone` may be merged into its neighbour `kept`: it is inside a sheet, or inside a curve of which the edge
  /// is part, and the links of the two meet in the link of the edge only (Dey, Edelsbrunner, Guha & Nekhayev 1999).
  bool can_collapse(Index gone, Index kept) const;
  void collapse(Index gone, Index kept);
  /// Whether the two triangles at the edge ab, which lies inside a sheet, can be replaced by the other two of their
  /// quadrilateral: its other diagonal is no edge yet.
  bool can_flip(Index a, Index b) const;
  void flip(Index a, Index b);
  /// A new vertex in the middle of an edge, inside the stratum in which the edge lies. Returns it.
  Index split(Index a, Index b);

 private:
  void add_face(const Triangle& corners, Index sheet);
  void remove_face(Index f);
  void replace_corner(Index f, Index from, Index to);
  static Index other_corner(const Triangle& t, Index a, Index b);

  std::vector<Triangle> corners_;  // in an order of no meaning, kept by edits that do not turn the face over
  std::vector<Index> sheet_;
  std::vector<bool> face_alive_, vertex_alive_;
  std::vector<Freedom> freedom_;
  std::vector<std::vector<Index>> faces_of_;  // per vertex
  std::vector<std::vector<Index>> curve_;     // per vertex
};

}  // namespace matstruct

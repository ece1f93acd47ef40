#include "rpd/pinch_contacts.h"

#include <algorithm>

#include "base/index.h"

namespace matstruct {

namespace {

// Collects the contacts of one piece.
class ContactFinder {
 public:
  ContactFinder(const Domain& domain, const std::vector<bool>& touching, std::vector<PinchContact>& out)
      : domain_(domain), touching_(touching), out_(out) {}

  void add(const Clipper& piece, Index tet, Index self) {
    for (const PieceVertex& v : piece.vertices()) {
      add_name(piece, tet, self, {v.planes[0], v.planes[1], v.planes[2]});
      for (std::size_t leaving = 0; leaving < 3; ++leaving)
        add_name(piece, tet, self, {v.planes[leaving == 0 ? 1 : 0], v.planes[leaving == 2 ? 1 : 2], kInvalid});
    }
  }

 private:
  // The face of the piece on the given planes, if it lies on a touching point or on an edge with one. An edge where the
  // solid touches itself may end in a point where it does not: where a slit ends, the solid is one all around it.
  void add_name(const Clipper& piece, Index tet, Index self, const std::array<int, 3>& planes) {
    std::array<bool, 4> off{};
    int facets = 0;
    PinchContact contact{{kInvalid, kInvalid}, {self, kInvalid}, tet};
    for (const int p : planes) {
      if (p == kInvalid) continue;
      if (p < kFirstBisector)
        off[uz(p)] = true, ++facets;
      else
        contact.spheres = {std::min(self, piece.sphere_of_plane(p)), std::max(self, piece.sphere_of_plane(p))};
    }
    if (facets < 2) return;
    std::size_t n = 0;
    for (std::size_t k = 0; k < 4; ++k)
      if (!off[k]) contact.simplex[n++] = domain_.points[uz(domain_.solid.tets[uz(tet)][k])];
    if (!touching_[uz(contact.simplex[0])] && (n == 1 || !touching_[uz(contact.simplex[1])])) return;
    if (n == 2) std::sort(contact.simplex.begin(), contact.simplex.end());
    out_.push_back(contact);
  }

  const Domain& domain_;
  const std::vector<bool>& touching_;
  std::vector<PinchContact>& out_;
};

}  // namespace

std::vector<PinchContact> pinch_contacts(const Domain& domain, const RpdEngine& engine) {
  std::vector<bool> touching(domain.points.size(), false);
  bool any = false;
  for (Index v = 0; v < count(domain.points); ++v)
    if (domain.points[uz(v)] != v) touching[uz(domain.points[uz(v)])] = any = true;
  std::vector<PinchContact> contacts;
  if (!any) return contacts;

  ContactFinder finder(domain, touching, contacts);
  Clipper clipper;
  const Rpd& rpd = engine.diagram();
  for (Index t = 0; t < count(domain.solid.tets); ++t) {
    const Tetrahedron& tet = domain.solid.tets[uz(t)];
    if (std::none_of(tet.begin(), tet.end(), [&](Index v) { return touching[uz(domain.points[uz(v)])]; })) continue;
    for (Index r = rpd.start[uz(t)][0]; r < rpd.start[uz(t) + 1][0]; ++r) {
      engine.piece(t, rpd.cells[uz(r)].sphere, clipper);
      finder.add(clipper, t, rpd.cells[uz(r)].sphere);
    }
  }
  std::sort(contacts.begin(), contacts.end());
  contacts.erase(std::unique(contacts.begin(), contacts.end()), contacts.end());
  return contacts;
}

}  // namespace matstruct

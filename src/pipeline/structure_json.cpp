// NAME.structure.json; docs/structure-schema.md is its manual.

#include <matstruct/compute.h>
#include <matstruct/version.h>

#include <nlohmann/json.hpp>

#include "base/index.h"

namespace matstruct {

namespace {

using Json = nlohmann::ordered_json;

// Of the schema. Raised by one for every change that could make a reader of the one before stumble.
constexpr int kSchemaVersion = 1;

Json json_of(const SheetStratum& s, Index id) {
  return {{"id", id},
          {"faces", s.faces},
          {"area", s.area},
          {"mean_radius", s.mean_radius},
          {"min_radius", s.min_radius},
          {"max_radius", s.max_radius},
          {"seams", s.seams},
          {"boundaries", s.boundaries},
          {"junctions", s.junctions}};
}

// kInvalid is null.
Json optional_id(Index id) {
  return id == kInvalid ? Json(nullptr) : Json(id);
}

Json json_of(const CurveStratum& c, Index id) {
  return {{"id", id},           {"vertices", c.vertices}, {"sheets", c.sheets},
          {"length", c.length}, {"closed", c.closed},     {"ends", {optional_id(c.ends[0]), optional_id(c.ends[1])}}};
}

Json json_of(const PointStratum& p, Index id) {
  return {{"id", id}, {"vertex", p.vertex}, {"seams", p.seams}, {"boundaries", p.boundaries}, {"curves", p.curves}};
}

template <class Stratum>
Json list_of(const std::vector<Stratum>& strata, Index first) {
  Json list = Json::array();
  for (const Stratum& s : strata) list.push_back(json_of(s, first++));
  return list;
}

Json json_of(const VertexContacts& c) {
  Json points = Json::array();
  for (const Vec3& p : c.points) points.push_back({p.x, p.y, p.z});
  return {{"start", c.start},
          {"points", std::move(points)},
          {"triangles", c.triangles},
          {"patch_of_triangle", c.patch_of_triangle}};
}

}  // namespace

std::string structure_json(const Result& result) {
  const Structure& s = result.structure;
  Json json;
  json["schema"] = "matstruct-structure";
  json["schema_version"] = kSchemaVersion;
  json["version"] = kVersion;
  json["mesh"] = {{"vertices", result.mesh.centers.size()},
                  {"edges", result.mesh.edges.size()},
                  {"faces", result.mesh.faces.size()}};
  json["sheets"] = list_of(s.sheets, 0);
  json["seams"] = list_of(s.seams, s.first_seam());
  json["boundaries"] = list_of(s.boundaries, s.first_boundary());
  for (Index k = 0; k < count(s.boundaries); ++k) json["boundaries"][uz(k)]["sharp"] = s.boundaries[uz(k)].sharp;
  json["curves"] = list_of(s.curves, s.first_curve());
  json["junctions"] = list_of(s.junctions, s.first_junction());
  json["corners"] = list_of(s.corners, s.first_corner());
  json["adjacency"] = s.adjacency;
  json["contacts"] = json_of(result.contacts);
  return json.dump() + "\n";
}

}  // namespace matstruct

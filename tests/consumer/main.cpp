// The least program that computes a medial mesh with the installed library: a unit cube of five tetrahedra.
#include <cstdio>

#include <matstruct/matstruct.h>

int main() {
  const matstruct::TetMesh cube = {
      .vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}},
      .tets = {{0, 1, 2, 4}, {1, 3, 2, 7}, {1, 4, 5, 7}, {2, 6, 4, 7}, {1, 2, 4, 7}}};
  matstruct::Context context;
  const matstruct::Result result = matstruct::compute(cube, {.gamma = 10}, context);
  const bool kept = matstruct::betti_numbers(result.mesh) == matstruct::betti_numbers(cube);
  std::printf("topology kept: %s\n", kept ? "yes" : "no");
  return kept ? 0 : 1;
}

// The line of triangulation/examples/hash_of_cells.rs, by CGAL's Delaunay_triangulation_3.
//
//   g++ -std=c++17 -O3 -DNDEBUG benches/cgal_hash.cpp -o cgal_hash -lgmp -lmpfr     (Debian: libcgal-dev)
//   ./cgal_hash FILE.xyz ...
#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Delaunay_triangulation_cell_base_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <utility>
#include <vector>

typedef CGAL::Exact_predicates_inexact_constructions_kernel K;
typedef CGAL::Triangulation_vertex_base_with_info_3<uint64_t, K> Vb;
typedef CGAL::Triangulation_data_structure_3<Vb, CGAL::Delaunay_triangulation_cell_base_3<K>> Tds;
typedef CGAL::Delaunay_triangulation_3<K, Tds> Delaunay;

// A step of splitmix64 (Steele, Lea and Flood 2014).
static uint64_t mixed(uint64_t z) {
    z += 0x9E3779B97F4A7C15;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EB;
    return z ^ (z >> 31);
}

int main(int argc, char** argv) {
    for (int i = 1; i < argc; i++) {
        std::vector<std::pair<K::Point_3, uint64_t>> points;
        FILE* file = fopen(argv[i], "rb");
        if (!file) return perror(argv[i]), 1;
        for (double p[3]; fread(p, sizeof p, 1, file) == 1;) points.push_back({{p[0], p[1], p[2]}, points.size()});
        fclose(file);
        Delaunay t(points.begin(), points.end());
        uint64_t count = 0, sum = 0;
        for (auto cell = t.finite_cells_begin(); cell != t.finite_cells_end(); ++cell, ++count) {
            uint64_t corners[4], hash = 0;
            for (int k = 0; k < 4; k++) corners[k] = cell->vertex(k)->info();
            std::sort(corners, corners + 4);
            for (uint64_t corner : corners) hash = mixed(hash ^ corner);
            sum += hash;
        }
        printf("%s %zu %llu %016llx\n", argv[i], points.size(), (unsigned long long)count, (unsigned long long)sum);
    }
}

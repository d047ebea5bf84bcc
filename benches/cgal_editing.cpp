// What triangulation/examples/bench_editing.rs does, by CGAL's Triangulation_hierarchy_2, in the same line format.
//
//   g++ -std=c++17 -O3 -DNDEBUG benches/cgal_editing.cpp -o cgal_editing -lgmp -lmpfr     (Debian: libcgal-dev)
//   ./cgal_editing FILE.xy
#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_hierarchy_2.h>
#include <chrono>
#include <cstdio>
#include <string>
#include <vector>

typedef CGAL::Exact_predicates_inexact_constructions_kernel K;
typedef CGAL::Triangulation_hierarchy_vertex_base_2<CGAL::Triangulation_vertex_base_2<K>> Vb;
typedef CGAL::Delaunay_triangulation_2<K, CGAL::Triangulation_data_structure_2<Vb, CGAL::Triangulation_face_base_2<K>>> Plain;
typedef CGAL::Triangulation_hierarchy_2<Plain> Hierarchy;

static std::string stem;
static size_t count;

template <class Task> void timed(const char* name, Task task) {
    auto start = std::chrono::steady_clock::now();
    size_t done = task();
    double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    printf("cgal_%s %s %zu 1 %.4f 0 0 %zu %.4f\n", name, stem.c_str(), count, seconds, done, seconds);
}

int main(int argc, char** argv) {
    if (argc < 2) return 2;
    std::string path = argv[1];
    stem = path.substr(path.find_last_of('/') + 1);
    stem = stem.substr(0, stem.find_last_of('.'));
    FILE* file = fopen(path.c_str(), "rb");
    if (!file) return 1;
    std::vector<K::Point_2> points;
    double xy[2];
    while (fread(xy, sizeof xy, 1, file) == 1) points.emplace_back(xy[0], xy[1]);
    fclose(file);
    count = points.size();

    Hierarchy t;
    std::vector<Hierarchy::Vertex_handle> vertices;
    vertices.reserve(count);
    timed("insert", [&] { for (auto& p : points) vertices.push_back(t.insert(p)); return t.number_of_faces(); });
    // Beside the vertices: the middle between two points that follow each other in the file.
    timed("locate", [&] {
        size_t inside = 0;
        for (size_t i = 1; i < count; i++) {
            auto face = t.locate(CGAL::midpoint(points[i - 1], points[i]));
            inside += face != nullptr && !t.is_infinite(face);
        }
        return inside;
    });
    timed("nearest", [&] {
        size_t sum = 0;
        for (size_t i = 1; i < count; i++) sum += t.nearest_vertex(CGAL::midpoint(points[i - 1], points[i])) != nullptr;
        return sum;
    });
    // Every second one, in the order of the file; each once.
    timed("remove", [&] {
        std::vector<Hierarchy::Vertex_handle> half;
        for (size_t i = 0; i < count; i += 2) half.push_back(vertices[i]);
        std::sort(half.begin(), half.end());
        half.erase(std::unique(half.begin(), half.end()), half.end());
        if (half.size() * 2 == count) { half.clear(); for (size_t i = 0; i < count; i += 2) half.push_back(vertices[i]); }
        for (auto v : half) t.remove(v);
        return t.number_of_faces();
    });
}

// What triangulation/examples/bench_editing.rs does, by CGAL's Triangulation_hierarchy_2, in space by
// Delaunay_triangulation_3 with Fast_location (alpha shapes by Alpha_shape_3), in the same line format. Hidden points
// by Regular_triangulation_2 and _3; in space, CGAL has no vertices for them, and none can be removed alone.
//
//   g++ -std=c++17 -O3 -DNDEBUG benches/cgal_editing.cpp -o cgal_editing -lgmp -lmpfr     (Debian: libcgal-dev)
//   ./cgal_editing FILE.xy|FILE.xyz
#include <CGAL/Alpha_shape_3.h>
#include <CGAL/Alpha_shape_cell_base_3.h>
#include <CGAL/Alpha_shape_vertex_base_3.h>
#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Regular_triangulation_2.h>
#include <CGAL/Regular_triangulation_3.h>
#include <CGAL/Triangulation_hierarchy_2.h>
#include <algorithm>
#include <chrono>
#include <cfloat>
#include <cstdio>
#include <string>
#include <vector>

typedef CGAL::Exact_predicates_inexact_constructions_kernel K;
typedef CGAL::Triangulation_hierarchy_vertex_base_2<CGAL::Triangulation_vertex_base_2<K>> Vb;
typedef CGAL::Delaunay_triangulation_2<K, CGAL::Triangulation_data_structure_2<Vb, CGAL::Triangulation_face_base_2<K>>> Plain;
typedef CGAL::Triangulation_hierarchy_2<Plain> Hierarchy;
typedef CGAL::Delaunay_triangulation_3<K, CGAL::Fast_location> InSpace;
typedef CGAL::Triangulation_data_structure_3<CGAL::Alpha_shape_vertex_base_3<K>, CGAL::Alpha_shape_cell_base_3<K>> WithAlphas;
typedef CGAL::Delaunay_triangulation_3<K, WithAlphas> ForAlphas;
typedef CGAL::Alpha_shape_3<ForAlphas> Alphas;
typedef CGAL::Regular_triangulation_2<K> Regular2;
typedef CGAL::Regular_triangulation_3<K> Regular3;

static std::string stem;
static size_t count;

template <class Task> void timed(const char* name, Task task) {
    auto start = std::chrono::steady_clock::now();
    size_t done = task();
    double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    printf("cgal_%s %s %zu 1 %.4f 0 0 %zu %.4f\n", name, stem.c_str(), count, seconds, done, seconds);
}

static size_t cells(const Hierarchy& t) { return t.number_of_faces(); }
static size_t cells(const InSpace& t) { return t.number_of_finite_cells(); }

template <class T, class Point> void measure(const std::vector<Point>& points) {
    count = points.size();
    T t;
    std::vector<typename T::Vertex_handle> vertices;
    vertices.reserve(count);
    timed("insert", [&] { for (auto& p : points) vertices.push_back(t.insert(p)); return cells(t); });
    // Beside the vertices: the middle between two points that follow each other in the file.
    timed("locate", [&] {
        size_t inside = 0;
        for (size_t i = 1; i < count; i++) {
            auto cell = t.locate(CGAL::midpoint(points[i - 1], points[i]));
            inside += cell != nullptr && !t.is_infinite(cell);
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
        std::vector<typename T::Vertex_handle> half;
        for (size_t i = 0; i < count; i += 2) half.push_back(vertices[i]);
        auto sorted = half;
        std::sort(sorted.begin(), sorted.end());
        sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
        for (auto v : sorted.size() == half.size() ? half : sorted) t.remove(v);
        return cells(t);
    });
}

// All points under one cell around them, too light to be seen.
static void hide(const std::vector<K::Point_2>& points) {
    double low = DBL_MAX, high = -DBL_MAX;
    for (auto& p : points) for (double x : {p.x(), p.y()}) low = std::min(low, x), high = std::max(high, x);
    double span = high - low + 1, from = low - span, to = from + 8 * span;
    Regular2 t;
    for (auto& p : {K::Point_2(from, from), K::Point_2(to, from), K::Point_2(from, to)}) t.insert(K::Weighted_point_2(p, 0));
    std::vector<Regular2::Vertex_handle> hidden;
    hidden.reserve(points.size());
    timed("hide", [&] {
        for (auto& p : points) hidden.push_back(t.insert(K::Weighted_point_2(p, -100 * span * span)));
        return t.number_of_hidden_vertices();
    });
    timed("remove_hidden", [&] {
        for (auto v : hidden) t.remove(v);
        return hidden.size();
    });
}

static void hide(const std::vector<K::Point_3>& points) {
    double low = DBL_MAX, high = -DBL_MAX;
    for (auto& p : points) for (double x : {p.x(), p.y(), p.z()}) low = std::min(low, x), high = std::max(high, x);
    double span = high - low + 1, from = low - span, to = from + 12 * span;
    Regular3 t;
    for (auto& p : {K::Point_3(from, from, from), K::Point_3(to, from, from), K::Point_3(from, to, from), K::Point_3(from, from, to)})
        t.insert(K::Weighted_point_3(p, 0));
    timed("hide", [&] {
        for (auto& p : points) t.insert(K::Weighted_point_3(p, -100 * span * span));
        size_t hidden = 0;
        for (auto cell : t.finite_cell_handles()) hidden += std::distance(cell->hidden_points_begin(), cell->hidden_points_end());
        return hidden;
    });
}

static void alpha_shapes(const std::vector<K::Point_3>& points) {
    ForAlphas t(points.begin(), points.end());
    timed("alpha", [&] { return Alphas(t, 0, Alphas::GENERAL).number_of_alphas(); });
}

int main(int argc, char** argv) {
    if (argc < 2) return 2;
    std::string path = argv[1];
    stem = path.substr(path.find_last_of('/') + 1);
    auto dot = stem.find_last_of('.');
    bool in_space = stem.substr(dot) == ".xyz";
    stem = stem.substr(0, dot);
    FILE* file = fopen(path.c_str(), "rb");
    if (!file) return 1;
    std::vector<K::Point_2> points;
    std::vector<K::Point_3> points_in_space;
    double p[3];
    while (fread(p, (in_space ? 3 : 2) * sizeof *p, 1, file) == 1) {
        if (in_space) points_in_space.emplace_back(p[0], p[1], p[2]);
        else points.emplace_back(p[0], p[1]);
    }
    fclose(file);
    if (in_space) {
        measure<InSpace>(points_in_space);
        hide(points_in_space);
        alpha_shapes(points_in_space);
    } else {
        measure<Hierarchy>(points);
        hide(points);
    }
}

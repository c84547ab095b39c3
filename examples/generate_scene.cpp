// Writes test scenes as OBJ, with the number of patches of one's choice: what docs/accuracy.md measures.
//
//   generate_scene cube K               closed unit cube, K x K quads a side
//   generate_scene room K [M]           the same with a floating box, M x M quads a side (default about 0.46
//   K) generate_scene boxes COUNT K M      the cube with COUNT rotated boxes (2, 8 or 27) floating on a grid
//   generate_scene street HOUSES K M    an open street: ground K x K, HOUSES boxes standing on it, M x M
//   quads a side generate_scene torus K              a torus in an inward sphere, about K triangles each
//   generate_scene ball K               a rough ball seen from inside, about K triangles, no two in one
//                                       plane, and a square lamp (group lamp) under its top
//   generate_scene blocks K             a closed unit room with two turned blocks and a lamp in the ceiling,
//                                       K x K quads a side, K a multiple of 8; about 7.4 K^2 quads
//   generate_scene finishes FILE        the scene file (JSON) that gives the blocks of FILE their finishes
//
// Each writes to standard output; groups: room or ground, box<i>, sphere, torus. Material: white; of blocks:
// floor, ceiling, lamp, left, right, front, back, block.

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <random>
#include <string>
#include <vector>

namespace {

struct Point {
  double x, y, z;
};

Point operator+(Point a, Point b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
Point operator-(Point a, Point b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
Point operator*(double s, Point a) {
  return {s * a.x, s * a.y, s * a.z};
}

class ObjWriter {
 public:
  ObjWriter() { std::puts("usemtl white"); }

  void begin_group(const std::string& name) { std::printf("g %s\n", name.c_str()); }

  // A parallelogram corner + s u + t v cut into n x m quads; its front is where u x v points.
  void grid(Point corner, Point u, Point v, int n, int m) {
    part_of_grid(grid_vertices(corner, u, v, n, m), n, m, [](int, int) { return true; });
  }

  // The quads of a grid as above whose (i, j) satisfy `wanted`, with vertices from an earlier call on.
  template <class Wanted>
  void part_of_grid(int first, int n, int m, Wanted wanted) {
    for (int j = 0; j < m; ++j) {
      for (int i = 0; i < n; ++i) {
        const int a = first + j * (n + 1) + i;
        if (wanted(i, j)) std::printf("f %d %d %d %d\n", a, a + 1, a + n + 2, a + n + 1);
      }
    }
  }
  int grid_vertices(Point corner, Point u, Point v, int n, int m) {
    const int first = vertices_ + 1;
    for (int j = 0; j <= m; ++j) {
      for (int i = 0; i <= n; ++i) vertex(corner + double(i) / n * u + double(j) / m * v);
    }
    return first;
  }
  void begin_material(const std::string& name) {
    std::printf("g %s\nusemtl %s\n", name.c_str(), name.c_str());
  }

  // The six sides of a box with edge vectors u, v, w (right-handed), seen from outside or from inside.
  void box(Point corner, Point u, Point v, Point w, int n, bool inward, bool with_bottom = true) {
    const auto side = [&](Point c, Point a, Point b) { inward ? grid(c, b, a, n, n) : grid(c, a, b, n, n); };
    if (with_bottom) side(corner, v, u);
    side(corner + w, u, v);
    side(corner, u, w);
    side(corner + v, w, u);
    side(corner, w, v);
    side(corner + u, v, w);
  }

  // A closed surface of revolution-like grid point(i / n, j / m), periodic in both, two triangles a cell.
  template <class PointAt>
  void periodic(PointAt point_at, int n, int m) {
    const int first = vertices_ + 1;
    for (int j = 0; j < m; ++j) {
      for (int i = 0; i < n; ++i) vertex(point_at(double(i) / n, double(j) / m));
    }
    for (int j = 0; j < m; ++j) {
      for (int i = 0; i < n; ++i) {
        const auto at = [&](int di, int dj) { return first + (j + dj) % m * n + (i + di) % n; };
        std::printf("f %d %d %d\nf %d %d %d\n", at(0, 0), at(1, 0), at(1, 1), at(0, 0), at(1, 1), at(0, 1));
      }
    }
  }

  // A sphere seen from inside: latitude rings between two poles; radius(theta) is asked for each vertex but
  // these.
  template <class Radius>
  void inward_sphere(int n, int m, const Radius& radius) {
    const int north = vertices_ + 1;
    vertex({0, 0, 1});
    for (int j = 1; j < m; ++j) {
      const double theta = std::numbers::pi * j / m;
      for (int i = 0; i < n; ++i) {
        const double phi = 2 * std::numbers::pi * i / n;
        vertex(radius(theta) *
               Point{std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)});
      }
    }
    vertex({0, 0, -1});
    const int south = vertices_;
    const auto at = [&](int i, int j) { return north + 1 + (j - 1) * n + i % n; };
    for (int i = 0; i < n; ++i) std::printf("f %d %d %d\n", north, at(i + 1, 1), at(i, 1));
    for (int j = 1; j + 1 < m; ++j) {
      for (int i = 0; i < n; ++i) {
        std::printf("f %d %d %d\nf %d %d %d\n", at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j),
                    at(i + 1, j + 1), at(i, j + 1));
      }
    }
    for (int i = 0; i < n; ++i) std::printf("f %d %d %d\n", at(i, m - 1), at(i + 1, m - 1), south);
  }

 private:
  void vertex(Point p) {
    std::printf("v %.17g %.17g %.17g\n", p.x, p.y, p.z);
    ++vertices_;
  }
  int vertices_ = 0;
};

// A box of these edge lengths around a centre, turned about z and then about x.
void rotated_box(ObjWriter& obj, Point centre, Point size, double about_z, double about_x, int n) {
  const auto turn = [&](Point p) {
    const Point q = {std::cos(about_z) * p.x - std::sin(about_z) * p.y,
                     std::sin(about_z) * p.x + std::cos(about_z) * p.y, p.z};
    return Point{q.x, std::cos(about_x) * q.y - std::sin(about_x) * q.z,
                 std::sin(about_x) * q.y + std::cos(about_x) * q.z};
  };
  const Point u = turn({size.x, 0, 0}), v = turn({0, size.y, 0}), w = turn({0, 0, size.z});
  obj.box(centre - 0.5 * (u + v + w), u, v, w, n, false);
}

void write_boxes(ObjWriter& obj, int count, int room_cells, int box_cells) {
  obj.begin_group("room");
  obj.box({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, room_cells, true);
  const int side = std::max(2, static_cast<int>(std::lround(std::cbrt(count))));
  const double edge = 0.36 / side;  // a turned box stays clear of its neighbours: edge * sqrt(3) < 1 / side
  std::mt19937 random(7);
  const auto angle = [&] { return random() / 4294967296.0 * std::numbers::pi; };
  for (int i = 0; i < count; ++i) {
    obj.begin_group("box" + std::to_string(i));
    // two boxes stand on a diagonal of the grid, 8 and 27 fill it
    const int x = i % side, y = count == 2 ? i : i / side % side, z = count == 2 ? i : i / side / side;
    const Point centre = {(x + 0.5) / side, (y + 0.5) / side, (z + 0.5) / side};
    const double about_z = angle(), about_x = angle();
    rotated_box(obj, centre, {edge, 1.2 * edge, 0.8 * edge}, about_z, about_x, box_cells);
  }
}

// A block of square ground plan, turned about the vertical y.
void write_block(ObjWriter& obj, double x, double z, double half, double bottom, double height, double angle,
                 int k) {
  const Point u = {2 * half * std::cos(angle), 0, 2 * half * std::sin(angle)};
  const Point w = {-2 * half * std::sin(angle), 0, 2 * half * std::cos(angle)};
  const Point v = {0, height, 0}, corner = Point{x, bottom, z} - 0.5 * (u + w);
  const int across = std::max(1, static_cast<int>(std::lround(2 * half * k)));
  const int up = std::max(1, static_cast<int>(std::lround(height * k)));
  obj.grid(corner, u, w, across, across);
  obj.grid(corner + v, w, u, across, across);
  obj.grid(corner, v, u, up, across);
  obj.grid(corner + w, u, v, across, up);
  obj.grid(corner, w, v, across, up);
  obj.grid(corner + u, v, w, up, across);
}

void write_blocks(ObjWriter& obj, int k) {
  const Point o = {0, 0, 0}, x = {1, 0, 0}, y = {0, 1, 0}, z = {0, 0, 1};
  const auto wall = [&](const char* name, Point corner, Point u, Point v) {
    obj.begin_material(name);
    obj.grid(corner, u, v, k, k);
  };
  wall("floor", o, z, x);
  wall("left", o, y, z);
  wall("right", x, z, y);
  wall("back", o, x, y);
  wall("front", z, y, x);
  const auto lit = [&](int i, int j) {
    const auto inside = [&](int c) { return c >= 3 * k / 8 && c < 5 * k / 8; };
    return inside(i) && inside(j);
  };
  const int first = obj.grid_vertices(y, x, z, k, k);
  obj.begin_material("ceiling");
  obj.part_of_grid(first, k, k, [&](int i, int j) { return !lit(i, j); });
  obj.begin_material("lamp");
  obj.part_of_grid(first, k, k, lit);
  obj.begin_material("block");
  write_block(obj, 0.33, 0.35, 0.15, 0.04, 0.6, 0.3, k);
  write_block(obj, 0.68, 0.66, 0.15, 0.04, 0.3, -0.29, k);
}

void write_finishes(const std::string& file) {
  std::printf("{\n  \"mesh\": \"%s\",\n  \"materials\": {\n", file.c_str());
  std::puts("    \"floor\": {\"reflectance\": 0.7},\n    \"ceiling\": {\"reflectance\": 0.8},");
  std::puts("    \"left\": {\"reflectance\": 0.3},\n    \"right\": {\"reflectance\": 0.5},");
  std::puts("    \"back\": {\"reflectance\": 0.6},\n    \"front\": {\"reflectance\": 0.6},");
  std::puts("    \"block\": {\"reflectance\": 0.7},");
  std::puts("    \"lamp\": {\"reflectance\": 0.8, \"exitance\": 10}\n  }\n}");
}

void write_street(ObjWriter& obj, int houses, int ground_cells, int house_cells) {
  const double plot = 20, width = 12, road = 16;
  const int a_row = (houses + 1) / 2;
  obj.begin_group("ground");
  obj.grid({0, 0, 0}, {plot * a_row, 0, 0}, {0, 2 * plot + road, 0}, ground_cells, ground_cells);
  std::mt19937 random(11);
  for (int i = 0; i < houses; ++i) {
    obj.begin_group("box" + std::to_string(i));
    const double height = 6 + 18 * (random() / 4294967296.0);
    const Point corner = {plot * (i / 2) + 4, i % 2 ? plot + road + 4 : 4, 0};
    obj.box(corner, {width, 0, 0}, {0, width, 0}, {0, 0, height}, house_cells, false, false);
  }
}

void write_torus(ObjWriter& obj, int triangles) {
  const double pi = std::numbers::pi;
  const int m = static_cast<int>(std::lround(std::sqrt(triangles / 4.0)));
  obj.begin_group("sphere");
  obj.inward_sphere(2 * m, m, [](double) { return 1.0; });
  obj.begin_group("torus");
  obj.periodic(
      [&](double s, double t) {
        const double ring = 0.5 + 0.2 * std::cos(2 * pi * t);
        return Point{ring * std::cos(2 * pi * s), ring * std::sin(2 * pi * s), 0.2 * std::sin(2 * pi * t)};
      },
      2 * m, m);
}

// Radii are moved at random by so much of a triangle's height that the normals of neighbours are some 30
// degrees apart.
void write_ball(ObjWriter& obj, int triangles) {
  const double pi = std::numbers::pi, roughness = 0.2;
  const int m = std::max(3, static_cast<int>(std::lround(std::sqrt(triangles / 4.0))));
  std::mt19937 random(5);
  obj.begin_group("ball");
  obj.inward_sphere(2 * m, m, [&](double theta) {
    return 1 + roughness * pi / m * std::sin(theta) * (2 * (random() / 4294967296.0) - 1);
  });
  obj.begin_group("lamp");
  obj.grid({-0.2, 0.2, 0.8}, {0.4, 0, 0}, {0, -0.4, 0}, 1, 1);
}

}  // namespace

int main(int count, char** arguments) {
  const auto number = [&](int i, int otherwise) { return count > i ? std::atoi(arguments[i]) : otherwise; };
  const std::string kind = count > 1 ? arguments[1] : "";
  if (kind == "finishes" && count > 2) {
    write_finishes(arguments[2]);
    return std::fflush(stdout) == 0 ? 0 : 1;
  }
  if (count < 3 || number(2, 0) < 1 || (kind == "blocks" && number(2, 0) % 8 != 0)) {
    std::fputs(
        "usage: generate_scene cube K | room K [M] | boxes COUNT K M | street HOUSES K M | torus K | ball K "
        "| "
        "blocks K (a multiple of 8) | finishes FILE\n",
        stderr);
    return 2;
  }
  ObjWriter obj;
  const int k = number(2, 1);
  if (kind == "cube" || kind == "room") {
    obj.begin_group("room");
    obj.box({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, k, true);
    if (kind == "room") {
      obj.begin_group("box0");
      obj.box({0.31, 0.27, 0.22}, {0.32, 0, 0}, {0, 0.31, 0}, {0, 0, 0.49}, number(3, (46 * k + 50) / 100),
              false);
    }
  } else if (kind == "boxes") {
    write_boxes(obj, k, number(3, 12), number(4, 4));
  } else if (kind == "street") {
    write_street(obj, k, number(3, 40), number(4, 10));
  } else if (kind == "torus") {
    write_torus(obj, k);
  } else if (kind == "ball") {
    write_ball(obj, k);
  } else if (kind == "blocks") {
    write_blocks(obj, k);
  } else {
    std::fprintf(stderr, "generate_scene: unknown scene '%s'\n", kind.c_str());
    return 2;
  }
  return std::fflush(stdout) == 0 ? 0 : 1;
}

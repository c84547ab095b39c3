#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "luxel/input_error.h"
#include "meshing/scenes.h"

namespace luxel {
namespace {

struct Damage {
  const char* named;  // what the message must say
  std::function<void(Scene&)> inflict;
};

TEST(Validate, AcceptsASoundScene) {
  EXPECT_NO_THROW(validate(SceneMaker().room({0, 0, 0}, {1, 1, 1}).scene()));
  EXPECT_NO_THROW(validate(Scene{}));
}

TEST(Validate, NamesTheItemThatBreaksAPromise) {
  const std::vector<Damage> damages = {
      {"vertex 3", [](Scene& s) { s.vertices[3].y() = std::nan(""); }},
      {"vertex 3", [](Scene& s) { s.vertices[3].y() = 1e200; }},
      {"face 1: corner 2 is vertex 99", [](Scene& s) { s.face_vertices[6] = 99; }},
      {"face 1: corner 2 is vertex -1", [](Scene& s) { s.face_vertices[6] = -1; }},
      {"face 2: ends", [](Scene& s) { s.face_offsets[3] = 1; }},
      {"face offsets", [](Scene& s) { s.face_offsets.back() = 23; }},
      {"face offsets", [](Scene& s) { s.face_offsets.front() = 1; }},
      {"face 4: group 7", [](Scene& s) { s.face_groups[4] = 7; }},
      {"face 4: material -1", [](Scene& s) { s.face_materials[4] = -1; }},
      {"face 0: finish 1", [](Scene& s) { s.face_finishes[0] = 1; }},
      {"5 finish indices, expected 6", [](Scene& s) { s.face_finishes.pop_back(); }},
      {"finish 0: reflectance 1.1", [](Scene& s) { s.finishes[0].reflectance[1] = 1.1; }},
      {"finish 0: reflectance", [](Scene& s) { s.finishes[0].reflectance[1] = std::nan(""); }},
      {"finish 0: emission -1", [](Scene& s) { s.finishes[0].emission[2] = -1; }},
      {"finish 0: emission inf", [](Scene& s) { s.finishes[0].emission[2] = INFINITY; }},
      {"camera: fov 180", [](Scene& s) { s.camera = Camera{.fov = 180}; }},
      {"camera: 0 x 600", [](Scene& s) { s.camera = Camera{.width = 0}; }},
  };
  for (const Damage& damage : damages) {
    Scene scene = SceneMaker().room({0, 0, 0}, {1, 1, 1}).scene();
    scene.file = "room.obj";
    damage.inflict(scene);
    try {
      validate(scene);
      ADD_FAILURE() << damage.named;
    } catch (const InputError& error) {
      const std::string message = error.what();
      EXPECT_EQ(message.find("room.obj: "), 0u) << message;
      EXPECT_NE(message.find(damage.named), std::string::npos) << message;
    }
  }
}

}  // namespace
}  // namespace luxel

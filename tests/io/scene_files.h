#pragma once

#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "io/scratch.h"
#include "luxel/input_error.h"
#include "luxel/read_scene.h"

namespace luxel::testing {

/// Small input files in a folder of the running test's own.
class SceneFiles {
 public:
  SceneFiles& with(const std::string& name, std::string_view text) {
    std::ofstream(scratch_ / name, std::ios::binary) << text;
    return *this;
  }

  Scene read(const std::string& name, const ReadOptions& options = {}) const {
    return read_scene(scratch_ / name, options);
  }

  /// The message of the InputError that reading throws, without the folder; empty where none is thrown.
  std::string refusal_of(const std::string& name) const {
    try {
      read(name);
    } catch (const InputError& error) {
      std::string message = error.what();
      const std::string folder = scratch_.folder().string() + "/";
      for (auto at = message.find(folder); at != std::string::npos; at = message.find(folder)) {
        message.erase(at, folder.size());
      }
      return message;
    }
    return "";
  }

  std::filesystem::path operator/(const std::string& name) const { return scratch_ / name; }

 private:
  Scratch scratch_;
};

/// The unit square in z = 0, front up.
inline constexpr std::string_view square_vertices = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

/// The finish of a face.
inline const Finish& finish_of(const Scene& scene, int face) {
  return scene.finishes[scene.face_finishes[face]];
}

inline const std::string& group_of(const Scene& scene, int face) {
  return scene.groups[scene.face_groups[face]];
}

inline const std::string& material_of(const Scene& scene, int face) {
  return scene.materials[scene.face_materials[face]];
}

inline std::vector<int> corners_of(const Scene& scene, int face) {
  return {scene.face_vertices.begin() + scene.face_offsets[face],
          scene.face_vertices.begin() + scene.face_offsets[face + 1]};
}

}  // namespace luxel::testing

#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>

#include "luxel/dense_operator.h"
#include "luxel/form_factors.h"
#include "luxel/patch_mesh.h"
#include "luxel/progress.h"

namespace luxel {

/// How a saved operator came about: what a run that loads it reports in place of its own assembly.
struct OperatorRecord {
  FormFactorOptions options;
  FormFactorReport form_factors;
  ClosureReport closure;
  Enclosures enclosures;
};

/// A dense operator as it was saved: applied to the same numbers it gives the same bits.
struct SavedOperator {
  std::unique_ptr<DenseOperator> transport;
  OperatorRecord record;
};

/// Writes the operator of this mesh, to be used again by load_operator(). The file appears whole or not at
/// all; entries are streamed, so that memory never holds a second copy. Size: that of the entries and some 60
/// bytes a patch.
/// @throws InputError if the file cannot be written; Cancelled
void save_operator(const std::filesystem::path& path, const PatchMesh& mesh, const DenseOperator& transport,
                   const OperatorRecord& record, const Progress& progress = {});

/// Reads what save_operator() wrote. Everything is checked before it is used: kind of file, version, byte
/// order, size, checksum, and that the mesh has the geometry that the operator was made for.
/// @throws InputError in one line that names the file and what is wrong; Cancelled; std::bad_alloc
SavedOperator load_operator(const std::filesystem::path& path, const PatchMesh& mesh,
                            const Progress& progress = {});

}  // namespace luxel

#include "transport/hierarchical/block_product.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <memory>

namespace luxel {

namespace {

// Nodes of one level in one task.
constexpr int nodes_a_task = 1024;

// Parts of the blocks that run at the same time, each with sums of its own for every node: more only where
// blocks are many for each node, or the sums would cost more than the blocks.
constexpr std::size_t most_parts = 8;

// Doubles of a node: light or irradiance at four nodes, and what is equal at all of them.
constexpr int values_a_node = 5;

template <class Blocks>
void renumber(Blocks& blocks, const std::vector<int>& number) {
  for (auto& block : blocks) {
    block.r = number[block.r];
    block.s = number[block.s];
  }
}

// Bytes to be read in one application.
std::size_t bytes_of(const BlockList& list) {
  return list.scalars.size() * sizeof(ScalarBlock) + list.linears.size() * sizeof(LinearBlock) +
         list.bilinears.size() * sizeof(BilinearBlock);
}

// Begins of runs of lists of about equal bytes, and the end.
std::vector<std::size_t> runs_of(const std::vector<BlockList>& lists, std::size_t count) {
  std::size_t total = 0, done = 0;
  for (const BlockList& list : lists) total += bytes_of(list);
  std::vector<std::size_t> runs{0};
  for (std::size_t k = 0; k < lists.size(); ++k) {
    done += bytes_of(lists[k]);
    if (runs.size() < count && done * count >= total * runs.size()) runs.push_back(k + 1);
  }
  runs.push_back(lists.size());
  return runs;
}

// Adds to the irradiance h of both ends what the light q of the other sends. Sums are kept apart from memory
// until they are whole: the compiler cannot know that q and h never overlap.
template <int columns>
void exchange(const ScalarBlock& block, const double* qr, const double* qs, double* hr, double* hs) {
  constexpr int common = 4 * columns;
  const double value = block.value;
  for (int c = 0; c < columns; ++c) {
    hr[common + c] += value * qs[common + c];
    hs[common + c] += value * qr[common + c];
  }
}

template <int columns>
void exchange(const LinearBlock& block, const double* qr, const double* qs, double* hr, double* hs) {
  constexpr int common = 4 * columns;
  std::array<double, common> to_r;
  std::array<double, columns> to_s{};
  for (int a = 0; a < 4; ++a) {
    const double value = block.values[a];
    for (int c = 0; c < columns; ++c) {
      to_r[a * columns + c] = value * qs[common + c];
      to_s[c] += value * qr[a * columns + c];
    }
  }
  for (int k = 0; k < common; ++k) hr[k] += to_r[k];
  for (int c = 0; c < columns; ++c) hs[common + c] += to_s[c];
}

template <int columns>
void exchange(const BilinearBlock& block, const double* qr, const double* qs, double* hr, double* hs) {
  constexpr int size = 4 * columns;
  std::array<double, size> from_r, from_s, to_r{}, to_s{};
  for (int k = 0; k < size; ++k) {
    from_r[k] = qr[k];
    from_s[k] = qs[k];
  }
  for (int a = 0; a < 4; ++a) {
    for (int b = 0; b < 4; ++b) {
      const double value = block.values[4 * a + b];
      for (int c = 0; c < columns; ++c) {
        to_r[a * columns + c] += value * from_s[b * columns + c];
        to_s[b * columns + c] += value * from_r[a * columns + c];
      }
    }
  }
  for (int k = 0; k < size; ++k) {
    hr[k] += to_r[k];
    hs[k] += to_s[k];
  }
}

template <class Body>
void for_nodes(int begin, int end, const Body& body) {
  if (end - begin <= nodes_a_task) {
    for (int n = begin; n < end; ++n) body(n);
    return;
  }
  tbb::parallel_for(
      tbb::blocked_range<int>(begin, end, nodes_a_task),
      [&](const tbb::blocked_range<int>& range) {
        for (int n = range.begin(); n < range.end(); ++n) body(n);
      },
      tbb::simple_partitioner());
}

}  // namespace

BlockProduct::BlockProduct(ActiveTree tree, std::vector<BlockList> lists, std::vector<double> areas)
    : tree_(std::move(tree)), lists_(std::move(lists)), areas_(std::move(areas)) {
  std::size_t blocks = 0;
  for (BlockList& list : lists_) {
    blocks += list.size();
    renumber(list.scalars, tree_.number);
    renumber(list.linears, tree_.number);
    renumber(list.bilinears, tree_.number);
  }
  tree_.number = {};
  const std::size_t nodes = std::max<std::size_t>(tree_.nodes.size(), 1);
  parts_ = runs_of(lists_, std::clamp<std::size_t>(2 * blocks / nodes, 2, most_parts));
}

std::size_t BlockProduct::bytes() const {
  std::size_t bytes =
      tree_.nodes.size() * (sizeof(ActiveNode) + 16 * sizeof(float)) + areas_.size() * sizeof(double);
  for (const BlockList& list : lists_) bytes += sizeof(BlockList) + bytes_of(list);
  return bytes;
}

void BlockProduct::apply(const double* x, double* y, int columns) const {
  int done = 0;
  for (; columns - done >= 3; done += 3) apply_columns<3>(x + done, y + done, columns);
  if (columns - done == 2) {
    apply_columns<2>(x + done, y + done, columns);
  } else if (columns - done == 1) {
    apply_columns<1>(x + done, y + done, columns);
  }
}

template <int columns>
void BlockProduct::apply_columns(const double* x, double* y, int stride) const {
  constexpr int size = values_a_node * columns, common = 4 * columns;
  const std::size_t total = tree_.nodes.size() * size;
  const auto light = std::make_unique_for_overwrite<double[]>(total);  // at the four nodes, and their sum
  const auto lit = [&](int n) { return light.get() + static_cast<std::size_t>(n) * size; };
  for (std::size_t level = tree_.levels.size() - 1; level-- > 0;) {
    for_nodes(tree_.levels[level], tree_.levels[level + 1], [&](int n) {
      const ActiveNode& node = tree_.nodes[n];
      double* q = lit(n);
      std::fill_n(q, size, 0.0);
      if (node.single) {
        for (int c = 0; c < columns; ++c) {
          q[common + c] = areas_[node.unknown] * x[static_cast<std::size_t>(node.unknown) * stride + c];
        }
        return;
      }
      if (node.unknown >= 0) {
        for (int a = 0; a < 4; ++a) {
          const std::size_t row = static_cast<std::size_t>(node.unknown) + a;
          for (int c = 0; c < columns; ++c) q[a * columns + c] = areas_[row] * x[row * stride + c];
        }
      }
      for (int k = node.first_child; k < node.first_child + node.child_count; ++k) {
        const std::array<float, 16>& t = tree_.transfer[k];
        const double* child = lit(k);
        if (tree_.nodes[k].single) {
          for (int a = 0; a < 4; ++a) {
            for (int c = 0; c < columns; ++c) q[a * columns + c] += t[a] * child[common + c];
          }
          continue;
        }
        for (int z = 0; z < 4; ++z) {
          for (int a = 0; a < 4; ++a) {
            for (int c = 0; c < columns; ++c) q[a * columns + c] += t[4 * z + a] * child[z * columns + c];
          }
        }
      }
      for (int c = 0; c < columns; ++c) {
        q[common + c] = q[c] + q[columns + c] + q[2 * columns + c] + q[3 * columns + c];
      }
    });
  }

  std::vector<std::vector<double>> sums(parts_.size() - 1);
  tbb::parallel_for(std::size_t{0}, sums.size(), [&](std::size_t part) {
    sums[part].assign(total, 0.0);
    double* const h = sums[part].data();
    const auto at = [&](int n) { return h + static_cast<std::size_t>(n) * size; };
    const auto of_part = [&](const auto blocks, const auto& body) {
      for (std::size_t k = parts_[part]; k < parts_[part + 1]; ++k) {
        for (const auto& block : lists_[k].*blocks) body(block);
      }
    };
    of_part(&BlockList::scalars, [&](const ScalarBlock& block) {
      exchange<columns>(block, lit(block.r), lit(block.s), at(block.r), at(block.s));
    });
    of_part(&BlockList::linears, [&](const LinearBlock& block) {
      exchange<columns>(block, lit(block.r), lit(block.s), at(block.r), at(block.s));
    });
    of_part(&BlockList::bilinears, [&](const BilinearBlock& block) {
      exchange<columns>(block, lit(block.r), lit(block.s), at(block.r), at(block.s));
    });
  });

  std::vector<double>& irradiance = sums[0];
  for (std::size_t level = 0; level + 1 < tree_.levels.size(); ++level) {
    for_nodes(tree_.levels[level], tree_.levels[level + 1], [&](int n) {
      const ActiveNode& node = tree_.nodes[n];
      double* h = irradiance.data() + static_cast<std::size_t>(n) * size;
      for (std::size_t part = 1; part < sums.size(); ++part) {
        const double* more = sums[part].data() + static_cast<std::size_t>(n) * size;
        for (int k = 0; k < size; ++k) h[k] += more[k];
      }
      const double* from =
          node.parent < 0 ? nullptr : irradiance.data() + static_cast<std::size_t>(node.parent) * size;
      const std::array<float, 16>& t = tree_.transfer[n];
      if (node.single) {
        for (int c = 0; c < columns; ++c) {
          double value = h[common + c];
          for (int a = 0; from && a < 4; ++a) value += t[a] * from[a * columns + c];
          y[static_cast<std::size_t>(node.unknown) * stride + c] = value;
        }
        return;
      }
      for (int z = 0; z < 4; ++z) {
        for (int c = 0; c < columns; ++c) {
          double value = h[z * columns + c] + h[common + c];
          for (int a = 0; from && a < 4; ++a) value += t[4 * z + a] * from[a * columns + c];
          h[z * columns + c] = value;
          if (node.unknown >= 0) y[(static_cast<std::size_t>(node.unknown) + z) * stride + c] = value;
        }
      }
    });
  }
}

}  // namespace luxel

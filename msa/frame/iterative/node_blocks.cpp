#include "msa/frame/iterative/node_blocks.h"
#include "msa/base/index.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace deflect::frame {
namespace {

/// Neighbours of nodes, without themselves, ascending.
struct Graph {
  std::vector<int> start, neighbour;
  int size() const { return static_cast<int>(start.size()) - 1; }
};

Graph graph_of(int nodes, const SparsePattern& p, const std::vector<int>& node_of_q) {
  std::vector<std::vector<int>> lists(as_size(nodes));
  for (int j = 0; j < p.n; ++j) {
    const int a = nth(node_of_q, j);
    std::vector<int>& list = nth(lists, a);
    for (int k = nth(p.column_start, j); k < p.column_start[as_size(j) + 1]; ++k) {
      const int b = nth(node_of_q, nth(p.row, k));
      if (a == b || (!list.empty() && list.back() == b)) continue;
      if (std::find(list.begin(), list.end(), b) != list.end()) continue;
      list.push_back(b);
      nth(lists, b).push_back(a);
    }
  }
  Graph g{{0}, {}};
  for (std::vector<int>& list : lists) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
    g.neighbour.insert(g.neighbour.end(), list.begin(), list.end());
    g.start.push_back(static_cast<int>(g.neighbour.size()));
  }
  return g;
}

/// Levels of the component of `root`, appended to `order`; where each begins, appended to `levels`.
void search(const Graph& g, int root, std::vector<char>& seen, std::vector<int>& order, std::vector<int>& levels) {
  order.push_back(root);
  nth(seen, root) = 1;
  std::size_t from = order.size() - 1;
  while (from < order.size()) {
    levels.push_back(static_cast<int>(from));
    const std::size_t to = order.size();
    for (; from < to; ++from) {
      const auto node = as_size(order[from]);
      for (int k = g.start[node]; k < g.start[node + 1]; ++k) {
        const int next = nth(g.neighbour, k);
        if (nth(seen, next)) continue;
        nth(seen, next) = 1;
        order.push_back(next);
      }
    }
  }
}

/// All nodes by levels; each component from a node at its far end (two searches find one that is good enough).
std::vector<int> by_levels(const Graph& g, std::vector<int>& levels) {
  std::vector<int> order, trial, ignored;
  std::vector<char> seen(as_size(g.size()), 0), tried = seen;
  for (int node = 0; node < g.size(); ++node) {
    if (nth(seen, node)) continue;
    int root = node;
    for (int pass = 0; pass < 2; ++pass) {
      trial.clear(), ignored.clear();
      search(g, root, tried, trial, ignored);
      for (const int each : trial) nth(tried, each) = 0;
      root = trial.back();
    }
    search(g, root, seen, order, levels);
  }
  levels.push_back(g.size());
  return order;
}

/// Nodes that are free, by their first freedom.
struct FreeNodes {
  int number = 0;
  std::vector<int> of_q, freedom_of_q;
};

FreeNodes free_nodes(const Elimination& e, int freedoms) {
  FreeNodes out;
  for (int q = 0; q < freedoms; ++q) {
    const auto k = as_size(q);
    const int dof = e.dof_of_q[k];
    const bool fresh = q == 0 || dof / 6 != e.dof_of_q[k - 1] / 6;
    out.of_q.push_back(fresh ? (q == 0 ? 0 : out.of_q.back() + 1) : out.of_q.back());
    out.freedom_of_q.push_back(dof % 6);
  }
  out.number = freedoms == 0 ? 0 : out.of_q.back() + 1;
  return out;
}

/// The order of the nodes in rows, and the parts of the rows.
std::vector<int> divided_order(const Graph& graph, NodeBlocks& out) {
  const int nodes = graph.size();
  std::vector<int> levels;
  std::vector<int> order = by_levels(graph, levels);
  // The level that divides the nodes most evenly goes last, the levels behind it run backwards.
  std::size_t middle = 0;
  while (middle + 2 < levels.size() && levels[middle] + levels[middle + 1] < nodes) ++middle;
  const int middle_from = levels.empty() ? 0 : levels[middle], middle_to = levels.size() < 2 ? 0 : levels[middle + 1];
  for (std::size_t k = 0; k + 1 < levels.size(); ++k)
    out.widest_level = std::max(out.widest_level, levels[k + 1] - levels[k]);
  out.first_end = middle_from;
  out.ends = nodes - (middle_to - middle_from);
  std::reverse(order.begin() + middle_to, order.end());
  std::rotate(order.begin() + middle_from, order.begin() + middle_to, order.end());
  return order;
}

/// Where blocks stand left of the diagonal, for the nodes in this order.
void set_columns(const Graph& graph, const std::vector<int>& order, const std::vector<int>& row_of_node,
                 NodeBlocks& out) {
  out.start.push_back(0);
  for (const int node : order) {
    const auto k = as_size(node);
    const int row = row_of_node[k];
    for (int at = graph.start[k]; at < graph.start[k + 1]; ++at) {
      const int column = nth(row_of_node, nth(graph.neighbour, at));
      if (column < row) out.column.push_back(column);
    }
    std::sort(out.column.begin() + out.start.back(), out.column.end());
    out.start.push_back(static_cast<int>(out.column.size()));
  }
}

/// The blocks of the scaled values, whose places are known.
void set_blocks(const SparsePattern& p, const std::vector<double>& values, NodeBlocks& out) {
  for (int j = 0; j < p.n; ++j)
    for (int k = nth(p.column_start, j); k < p.column_start[as_size(j) + 1]; ++k) {
      const int i = nth(p.row, k);
      const double value = nth(values, k) * out.scale(i) * out.scale(j);
      int a = nth(out.place, i), b = nth(out.place, j);
      if (a / 6 == b / 6) {
        Matrix6& block = nth(out.diagonal, a / 6);
        block(a % 6, b % 6) = block(b % 6, a % 6) = value;
        continue;
      }
      if (a < b) std::swap(a, b);
      const auto row = as_size(a / 6);
      const auto from = out.column.begin() + out.start[row], to = out.column.begin() + out.start[row + 1];
      nth(out.lower, std::lower_bound(from, to, b / 6) - out.column.begin())(a % 6, b % 6) = value;
    }
  for (Matrix6& block : out.diagonal)
    for (int i = 0; i < 6; ++i)
      if (block(i, i) == 0) block(i, i) = 1;
}

}  // namespace

VectorX NodeBlocks::gathered(const VectorX& by_q) const {
  VectorX out = VectorX::Zero(6 * rows());
  for (std::size_t q = 0; q < place.size(); ++q) out(place[q]) = scale(as_index(q)) * by_q(as_index(q));
  return out;
}

VectorX NodeBlocks::scattered(const VectorX& by_place) const {
  VectorX out(std::ssize(place));
  for (std::size_t q = 0; q < place.size(); ++q) out(as_index(q)) = scale(as_index(q)) * by_place(place[q]);
  return out;
}

NodeBlocks node_blocks(const Elimination& e, const SparsePattern& p, const std::vector<double>& values) {
  NodeBlocks out;
  out.scale.resize(p.n);
  for (int q = 0; q < p.n; ++q) out.scale(q) = 1 / std::sqrt(nth(values, nth(p.column_start, q)));
  const FreeNodes nodes = free_nodes(e, p.n);
  const Graph graph = graph_of(nodes.number, p, nodes.of_q);
  const std::vector<int> order = divided_order(graph, out);

  std::vector<int> row_of_node(as_size(nodes.number));
  for (int i = 0; i < nodes.number; ++i) nth(row_of_node, nth(order, i)) = i;
  for (int q = 0; q < p.n; ++q)
    out.place.push_back(6 * nth(row_of_node, nth(nodes.of_q, q)) + nth(nodes.freedom_of_q, q));

  set_columns(graph, order, row_of_node, out);
  out.diagonal.assign(as_size(nodes.number), Matrix6::Zero());
  out.lower.assign(out.column.size(), Matrix6::Zero());
  set_blocks(p, values, out);
  return out;
}

}  // namespace deflect::frame

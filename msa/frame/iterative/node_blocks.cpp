#include "msa/frame/iterative/node_blocks.h"

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
  std::vector<std::vector<int>> lists(static_cast<std::size_t>(nodes));
  for (int j = 0; j < p.n; ++j) {
    const int a = node_of_q[static_cast<std::size_t>(j)];
    std::vector<int>& list = lists[static_cast<std::size_t>(a)];
    for (int k = p.column_start[static_cast<std::size_t>(j)]; k < p.column_start[static_cast<std::size_t>(j) + 1];
         ++k) {
      const int b = node_of_q[static_cast<std::size_t>(p.row[static_cast<std::size_t>(k)])];
      if (a == b || (!list.empty() && list.back() == b)) continue;
      if (std::find(list.begin(), list.end(), b) != list.end()) continue;
      list.push_back(b);
      lists[static_cast<std::size_t>(b)].push_back(a);
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
  seen[static_cast<std::size_t>(root)] = 1;
  std::size_t from = order.size() - 1;
  while (from < order.size()) {
    levels.push_back(static_cast<int>(from));
    const std::size_t to = order.size();
    for (; from < to; ++from) {
      const auto node = static_cast<std::size_t>(order[from]);
      for (int k = g.start[node]; k < g.start[node + 1]; ++k) {
        const int next = g.neighbour[static_cast<std::size_t>(k)];
        if (seen[static_cast<std::size_t>(next)]) continue;
        seen[static_cast<std::size_t>(next)] = 1;
        order.push_back(next);
      }
    }
  }
}

/// All nodes by levels; each component from a node at its far end (two searches find one that is good enough).
std::vector<int> by_levels(const Graph& g, std::vector<int>& levels) {
  std::vector<int> order, trial, ignored;
  std::vector<char> seen(static_cast<std::size_t>(g.size()), 0), tried = seen;
  for (int node = 0; node < g.size(); ++node) {
    if (seen[static_cast<std::size_t>(node)]) continue;
    int root = node;
    for (int pass = 0; pass < 2; ++pass) {
      trial.clear(), ignored.clear();
      search(g, root, tried, trial, ignored);
      for (const int each : trial) tried[static_cast<std::size_t>(each)] = 0;
      root = trial.back();
    }
    search(g, root, seen, order, levels);
  }
  levels.push_back(g.size());
  return order;
}

}  // namespace

VectorX NodeBlocks::gathered(const VectorX& by_q) const {
  VectorX out = VectorX::Zero(6 * rows());
  for (std::size_t q = 0; q < place.size(); ++q)
    out(place[q]) = scale(static_cast<Eigen::Index>(q)) * by_q(static_cast<Eigen::Index>(q));
  return out;
}

VectorX NodeBlocks::scattered(const VectorX& by_place) const {
  VectorX out(static_cast<Eigen::Index>(place.size()));
  for (std::size_t q = 0; q < place.size(); ++q)
    out(static_cast<Eigen::Index>(q)) = scale(static_cast<Eigen::Index>(q)) * by_place(place[q]);
  return out;
}

NodeBlocks node_blocks(const Elimination& e, const SparsePattern& p, const std::vector<double>& values) {
  NodeBlocks out;
  out.scale.resize(p.n);
  std::vector<int> node_of_q, freedom_of_q;  // nodes that are free, by their first freedom
  for (int q = 0; q < p.n; ++q) {
    const auto k = static_cast<std::size_t>(q);
    const int dof = e.dof_of_q[k];
    const bool fresh = q == 0 || dof / 6 != e.dof_of_q[k - 1] / 6;
    node_of_q.push_back(fresh ? (q == 0 ? 0 : node_of_q.back() + 1) : node_of_q.back());
    freedom_of_q.push_back(dof % 6);
    out.scale(q) = 1 / std::sqrt(values[static_cast<std::size_t>(p.column_start[k])]);
  }
  const int nodes = p.n == 0 ? 0 : node_of_q.back() + 1;
  const Graph graph = graph_of(nodes, p, node_of_q);

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

  std::vector<int> row_of_node(static_cast<std::size_t>(nodes));
  for (int i = 0; i < nodes; ++i) row_of_node[static_cast<std::size_t>(order[static_cast<std::size_t>(i)])] = i;
  for (int q = 0; q < p.n; ++q)
    out.place.push_back(6 * row_of_node[static_cast<std::size_t>(node_of_q[static_cast<std::size_t>(q)])] +
                        freedom_of_q[static_cast<std::size_t>(q)]);

  out.start.push_back(0);
  for (const int node : order) {
    const auto k = static_cast<std::size_t>(node);
    const int row = row_of_node[k];
    for (int at = graph.start[k]; at < graph.start[k + 1]; ++at) {
      const int column = row_of_node[static_cast<std::size_t>(graph.neighbour[static_cast<std::size_t>(at)])];
      if (column < row) out.column.push_back(column);
    }
    std::sort(out.column.begin() + out.start.back(), out.column.end());
    out.start.push_back(static_cast<int>(out.column.size()));
  }
  out.diagonal.assign(static_cast<std::size_t>(nodes), Matrix6::Zero());
  out.lower.assign(out.column.size(), Matrix6::Zero());
  for (int j = 0; j < p.n; ++j)
    for (int k = p.column_start[static_cast<std::size_t>(j)]; k < p.column_start[static_cast<std::size_t>(j) + 1];
         ++k) {
      const int i = p.row[static_cast<std::size_t>(k)];
      const double value = values[static_cast<std::size_t>(k)] * out.scale(i) * out.scale(j);
      int a = out.place[static_cast<std::size_t>(i)], b = out.place[static_cast<std::size_t>(j)];
      if (a / 6 == b / 6) {
        Matrix6& block = out.diagonal[static_cast<std::size_t>(a / 6)];
        block(a % 6, b % 6) = block(b % 6, a % 6) = value;
        continue;
      }
      if (a < b) std::swap(a, b);
      const auto row = static_cast<std::size_t>(a / 6);
      const auto from = out.column.begin() + out.start[row], to = out.column.begin() + out.start[row + 1];
      out.lower[static_cast<std::size_t>(std::lower_bound(from, to, b / 6) - out.column.begin())](a % 6, b % 6) = value;
    }
  for (Matrix6& block : out.diagonal)
    for (int i = 0; i < 6; ++i)
      if (block(i, i) == 0) block(i, i) = 1;
  return out;
}

}  // namespace deflect::frame

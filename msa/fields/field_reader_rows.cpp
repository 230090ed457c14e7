// The fields of FieldReader that are rows of numbers.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "msa/base/index.h"
#include "msa/fields/field_examples.h"
#include "msa/fields/field_reader.h"

namespace deflect {

void FieldReader::matrix(const char* key, MatrixX& value, Eigen::Index size, Need need, const char* about) {
  std::vector<std::string> zeros(as_size(size), "0");
  const std::string sample = example_of(key, fmt::format("[[{}], ...]", fmt::join(zeros, ", ")));
  value.resize(0, 0);
  const YamlNode* node = find(key, need == Need::required, sample, about);
  if (!node) return;
  const std::string path = joined(path_, key);
  const auto refuse = [&](const YamlNode& at, const std::string& where) {
    fail(at, where,
         fmt::format("{0} rows of {0} numbers are wanted: write for example '{1}'",
                     size > 0 ? std::to_string(size) : "as many", sample));
  };
  const auto rows = std::ssize(node->children);
  if (node->kind != YamlNode::Kind::list || rows == 0 || (size > 0 && rows != size)) refuse(*node, path);
  value.resize(rows, rows);
  for (Eigen::Index i = 0; i < rows; ++i) {
    const YamlNode& row = nth(node->children, i);
    const std::string row_path = joined(path, std::to_string(i));
    if (row.kind != YamlNode::Kind::list || std::ssize(row.children) != rows) refuse(row, row_path);
    for (Eigen::Index j = 0; j < rows; ++j) {
      const YamlNode& item = nth(row.children, j);
      const std::string item_path = joined(row_path, std::to_string(j));
      note(item, item_path);
      value(i, j) = number(item, item_path, {Dimension::none, {}, std::nullopt}, sample);
    }
  }
}

void FieldReader::pairs(const char* key, Pairs& values, const std::array<Dimension, 2>& dimensions, Need need,
                        const char* about) {
  const auto sample = [&] {
    return example_of(
        key, fmt::format("[[0 {}, 0 {}], [{}, {}]]", units_of(dimensions[0]).front(), units_of(dimensions[1]).front(),
                         example_of(dimensions[0]), example_of(dimensions[1])));
  };
  values.clear();
  const YamlNode* node = find(key, need == Need::required, sample, about);
  if (!node) return;
  const std::string path = joined(path_, key);
  if (node->kind != YamlNode::Kind::list)
    fail(*node, path, fmt::format("a list of pairs is wanted: write for example '{}'", sample()));
  for (std::size_t i = 0; i < node->children.size(); ++i) {
    const YamlNode& pair = node->children[i];
    const std::string pair_path = joined(path, std::to_string(i));
    if (pair.kind != YamlNode::Kind::list || pair.children.size() != 2)
      fail(pair, pair_path, fmt::format("a pair is wanted: write for example '{}'", sample()));
    note(pair, pair_path);
    std::array<double, 2>& value = values.emplace_back();
    for (std::size_t k = 0; k < 2; ++k) {
      const std::string item_path = joined(pair_path, std::to_string(k));
      note(pair.children[k], item_path);
      value[k] = number(pair.children[k], item_path, {dimensions[k], {}, std::nullopt}, sample);
    }
  }
}

}  // namespace deflect

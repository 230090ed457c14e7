#include "meshes/vtu.h"

#include <fmt/format.h>

#include <iterator>
#include <string>
#include <string_view>

#include "msa/base/files.h"

namespace deflect {
namespace {

constexpr double mm_per_m = 1000;
constexpr int vtk_line = 3;

/// Text for an attribute in double quotes. XML 1.0 has no way to write most control characters: they become
/// spaces.
std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? ' ' : c;
    }
  }
  return out;
}

class Writer {
 public:
  template <typename... Args>
  void line(fmt::format_string<Args...> format, Args&&... args) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<Args>(args)...);
    text_ += '\n';
  }

  /// One line per element of `range`, whose text `print(element)` gives.
  template <typename Range, typename Print>
  void array(std::string_view type, std::string_view name, std::string_view more, const Range& range, Print print) {
    line(R"(<DataArray type="{}" Name="{}"{} format="ascii">)", type, escaped(name), more);
    for (const auto& element : range) (text_ += print(element)) += '\n';
    line("</DataArray>");
  }

  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

std::string numbers(const Vector3& v) { return fmt::format("{} {} {}", v.x(), v.y(), v.z()); }

/// VTK's ASCII form of a string: the codes of its bytes as signed characters, closed by a zero.
std::string codes(const std::string& text) {
  std::string out;
  for (const char c : text)
    if (c != 0) out += fmt::format("{} ", static_cast<int>(static_cast<signed char>(c)));
  return out + "0";
}

}  // namespace

void write_vtu(const std::filesystem::path& path, const LineMesh& mesh, const FieldData& fields) {
  check(mesh, fields);
  constexpr std::string_view vectors = R"( NumberOfComponents="3")";
  Writer w;
  w.line(R"(<?xml version="1.0" encoding="UTF-8"?>)");
  w.line(R"(<VTKFile type="UnstructuredGrid" version="0.1" byte_order="LittleEndian">)");
  w.line("<UnstructuredGrid>");
  w.line("<FieldData>");
  w.array("String", "group_names", fmt::format(R"( NumberOfTuples="{}")", mesh.groups.size()), mesh.groups, codes);
  w.line("</FieldData>");
  w.line(R"(<Piece NumberOfPoints="{}" NumberOfCells="{}">)", mesh.points.size(), mesh.cells.size());

  w.line("<PointData>");
  for (const PointField& field : fields.points) w.array("Float64", field.name, vectors, field.values, numbers);
  w.line("</PointData>");
  w.line("<CellData>");
  w.array("Int32", "group", "", mesh.cells, [](const LineCell& c) { return fmt::format("{}", c.group); });
  for (const CellField& field : fields.cells)
    w.array("Float64", field.name, "", field.values, [](double value) { return fmt::format("{}", value); });
  w.line("</CellData>");

  w.line("<Points>");
  w.array("Float64", "points_mm", vectors, mesh.points, [](const Vector3& p) { return numbers(mm_per_m * p); });
  w.line("</Points>");
  w.line("<Cells>");
  w.array("Int64", "connectivity", "", mesh.cells, [](const LineCell& c) { return fmt::format("{} {}", c.a, c.b); });
  w.array("Int64", "offsets", "", mesh.cells,
          [end = 0](const LineCell&) mutable { return fmt::format("{}", end += 2); });
  w.array("UInt8", "types", "", mesh.cells, [](const LineCell&) { return fmt::format("{}", vtk_line); });
  w.line("</Cells>");

  w.line("</Piece>");
  w.line("</UnstructuredGrid>");
  w.line("</VTKFile>");
  write_text(path, w.text());
}

}  // namespace deflect

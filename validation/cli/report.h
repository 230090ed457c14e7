// The page that commands write with --report.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "validation/cli/command.h"
#include "validation/compare/comparison.h"
#include "validation/effects/effect.h"
#include "validation/page/page.h"
#include "validation/page/page_scene.h"

namespace deflect::cli {

Option report_option(std::string* file);

/// Before any work: InputError where a page is asked for and this program was built without.
void require_pages(const std::string& file);

/// The page of versions of a device against one set of measurements; the parts in which the last differs from the first
/// are marked. With the comparison of the first and, of several, their history beside `results`.
void write_report(const std::string& file, const std::string& device, const std::vector<Comparison>& versions,
                  std::vector<PageResult> results);

/// The page of a diagnosis (--json's text): the device and, one after the other, with what was found missing.
void write_report_of_diagnosis(const std::string& file, const std::string& device, const Mechanism&,
                               const Measurements&, const std::vector<Effect>&, const ComparisonOptions&,
                               std::vector<PageResult> results);

/// The page of a device where it stands, under loads (N, Nmm).
void write_report_of_stands(const std::string& file, const std::string& device, const Mechanism&,
                            const std::vector<SceneStand>&, const std::vector<Vector6>& loads_N_Nmm, PageResult,
                            Geometry = Geometry::linear);

/// The page of what a command says of one file: a device or frame as drawn, a frame under its loads with its scene
/// (page_frame_scene.h), a matrix.
void write_report_of_file(const std::string& file, const std::filesystem::path& source, PageResult,
                          Json scene = nullptr);

/// The page of results alone, without a machine.
void write_report_of_results(const std::string& file, std::vector<PageResult>);

}  // namespace deflect::cli

// The page that commands write with --report.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "msa/mechanism/stand.h"
#include "validation/cli/command.h"
#include "validation/compare/comparison.h"
#include "validation/effects/effect.h"
#include "validation/page/page.h"
#include "validation/scene/machine_scene.h"

namespace deflect::cli {

Option report_option(std::string* file);

/// To call before any work. InputError if `file` is given and this program was built without pages.
void require_pages(const std::string& file);

/// The page of versions of a device against one set of measurements. It marks the parts in which the last version
/// differs from the first. It shows `results`, the comparison of the first version and, for several, their history.
void write_report(const std::string& file, const std::string& device, const std::vector<compare::Comparison>& versions,
                  std::vector<page::PageResult> results);

/// InputError where the result is a diagnosis of another device: told before its measurements are read, whose columns
/// would be complained of.
void require_diagnosis_of(const std::string& device, const page::PageResult&);

/// The page of results of this device (require_diagnosis_of). If one is a diagnosis, the versions are the device and
/// the device with each effect found, added one after the other.
void write_report_of_diagnosis(const std::string& file, const std::string& device, const subject::Subject&,
                               const measurement::Measurements&, const std::vector<effects::Effect>&,
                               const compare::ComparisonOptions&, int threads, std::vector<page::PageResult> results);

/// The page of a device at its stands, under loads (N, Nmm).
void write_report_of_stands(const std::string& file, const std::string& device, const Mechanism&,
                            const std::vector<scene::SceneStand>&, const std::vector<Vector6>& loads_N_Nmm,
                            page::PageResult, Geometry = Geometry::linear);

/// The page of a command's result on one file: a drawn device or frame, a matrix, or a frame under its loads with its
/// scene (page_frame_scene.h).
void write_report_of_file(const std::string& file, const std::filesystem::path& source, page::PageResult,
                          Json scene = nullptr);

/// The page of results alone, without a machine.
void write_report_of_results(const std::string& file, std::vector<page::PageResult>);

}  // namespace deflect::cli

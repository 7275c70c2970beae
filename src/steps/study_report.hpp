#pragma once
/// @file
/// What a parameter study says: table, file of columns, pictures.

#include <string>

#include <tautline/core/progress.hpp>
#include <tautline/output/run_directory.hpp>
#include <tautline/steps/parameter_study.hpp>

#include "steps/context.hpp"

namespace tautline::steps {

/// Rows of study.json: {"parameters": {name: text}, "status", "message", "directory", "values": {label:
/// number or null}}.
std::string study_text(const ParameterStudy& study, const Json& rows);
std::string study_csv(const ParameterStudy& study, const Json& rows);

/// study_<label>.png against the first parameter; and, of two or more quantities, study_trade.png: the first
/// against the second.
void draw_study(const ParameterStudy& study, const Json& rows, output::RunDirectory& files,
                Progress& progress);

}  // namespace tautline::steps

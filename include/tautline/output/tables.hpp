#pragma once
/// @file
/// CSV tables: nodes, cables, beams, the cut list and the nodes as stage 1 found them. 17 digits for lengths
/// and coordinates. All ids and node numbers count from 1. Names with commas or quotes are quoted.

#include <string>
#include <vector>

#include <tautline/model/model.hpp>
#include <tautline/model/response.hpp>
#include <tautline/model/state.hpp>

namespace tautline::output {

/// form_finding_nodes.csv: id,group,x,y,z. `id` counts from 1; `group` is the first selection or group of the
/// node.
void write_form_finding_nodes(const std::string& path, const model::Model& structure);
/// nodes.csv: id,group,x_ref,y_ref,z_ref,x,y,z,ux,uy,uz,rx,ry,rz; the last three are the rotation vector
/// [rad]
void write_nodes(const std::string& path, const model::Model& model, const model::State& state);
/// cables.csv: id,group,node_1,node_2,length,unstressed_length,tension,slack
void write_cables(const std::string& path, const model::Model& model, const model::Response& response);
/// beams.csv:
/// id,group,node_1,node_2,axial,shear_2,shear_3,torque,moment_2_start,moment_3_start,moment_2_end,moment_3_end
void write_beams(const std::string& path, const model::Model& model, const model::Response& response);
/// membranes.csv: id,group,node_1..node_4,principal_1,principal_2,state; Cauchy resultants [N/m]; node_4 is
/// empty for triangles
void write_membranes(const std::string& path, const model::Model& model, const model::Response& response);
/// shells.csv: id,group,node_1..node_4,n11,n22,n12,m11,m22,m12,q1,q2; in the shell's own axes [N/m], [N],
/// [N/m]
void write_shells(const std::string& path, const model::Model& model, const model::Response& response);
/// springs.csv: id,group,node_1,node_2,fx,fy,fz,mx,my,mz; in the spring's axes; node_2 is empty for one to
/// the ground
void write_springs(const std::string& path, const model::Model& model, const model::Response& response);
/// A text as a csv cell: quoted where it holds a comma, a quote or a line end (RFC 4180), and with an
/// apostrophe before what a spreadsheet would take for a formula.
std::string csv_cell(const std::string& text);
/// Any table of numbers: a header and columns of the same length, with 17 digits; NaN is an empty cell.
void write_columns(const std::string& path, const std::vector<std::string>& header,
                   const std::vector<std::vector<double>>& columns);
/// reactions.csv: node,fx,fy,fz,mx,my,mz; nodes that carry none are left out [N], [N m]
void write_reactions(const std::string& path, const model::Model& model, const Points& force,
                     const Points& moment);
/// cut_list.csv: what a workshop cuts: one row for each cable before subdivision (segments joined):
/// id,group,unstressed_length,marking_tension. `id` is that of the cable before subdivision; the tension is
/// the mean over its segments, by length.
void write_cut_list(const std::string& path, const model::Model& model, const model::Response& response);

}  // namespace tautline::output

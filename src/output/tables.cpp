#include <tautline/output/tables.hpp>

#include <cmath>
#include <cstring>
#include <iterator>
#include <map>
#include <utility>

#include <fmt/format.h>

#include <tautline/core/error.hpp>
#include <tautline/model/beam_ends.hpp>
#include "output/detail/files.hpp"

namespace tautline::output {

namespace {

/// Rows of text in memory, written at the end: 10^5 rows are a few megabytes.
class Table {
 public:
  explicit Table(const std::string& header) : text_(header) { text_ += '\n'; }
  template <typename... Args>
  void row(fmt::format_string<Args...> format, Args&&... args) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<Args>(args)...);
    text_ += '\n';
  }
  void write(const std::string& path) const { detail::write_file(path, text_); }

 private:
  std::string text_;
};

std::vector<std::string> group_cells(const model::Model& model) {
  std::vector<std::string> cells;
  for (const auto& group : model.groups) cells.push_back(csv_cell(group.name));
  return cells;
}

void label(std::vector<std::string>& labels, int node, const std::string& name) {
  auto& label = labels.at(static_cast<std::size_t>(node));
  if (label.empty()) label = name;
}

template <typename Elements>
void label_by_elements(std::vector<std::string>& labels, const Elements& elements,
                       const std::vector<std::string>& groups) {
  for (const auto& element : elements)
    for (const int node : element.nodes) label(labels, node, groups[static_cast<std::size_t>(element.group)]);
}

/// The first selection that lists the node; else the group of the first element at it.
std::vector<std::string> node_labels(const model::Model& model) {
  std::vector<std::string> labels(model.nodes.size());
  for (const auto& [name, selection] : model.selections)
    for (const int node : selection.nodes) label(labels, node, csv_cell(name));
  const auto groups = group_cells(model);
  model::for_each_kind(model, [&](const auto& elements) { label_by_elements(labels, elements, groups); });
  return labels;
}

void require_size(const std::string& path, const char* what, std::size_t have, std::size_t want) {
  if (have != want)
    throw LibraryError(fmt::format("cannot write {}: {} {} for a model with {}", path, have, what, want));
}

}  // namespace

void write_form_finding_nodes(const std::string& path, const model::Model& structure) {
  Table table("id,group,x,y,z");
  const auto labels = node_labels(structure);
  for (std::size_t i = 0; i < structure.nodes.size(); ++i) {
    const Vec3& x = structure.nodes[i];
    table.row("{},{},{:.17g},{:.17g},{:.17g}", i + 1, labels[i], x[0], x[1], x[2]);
  }
  table.write(path);
}

void write_nodes(const std::string& path, const model::Model& model, const model::State& state) {
  require_size(path, "displacements", state.displacement.size(), model.nodes.size());
  Table table("id,group,x_ref,y_ref,z_ref,x,y,z,ux,uy,uz,rx,ry,rz");
  const auto labels = node_labels(model);
  for (std::size_t i = 0; i < model.nodes.size(); ++i) {
    const Vec3 &x_ref = model.nodes[i], &u = state.displacement[i];
    const Vec3 x_cur = x_ref + u;
    const Eigen::AngleAxisd turn(state.rotation[i]);
    const Vec3 r = turn.angle() * turn.axis();
    table.row(
        "{},{},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.10g},{:.10g},{:."
        "10g}",
        i + 1, labels[i], x_ref[0], x_ref[1], x_ref[2], x_cur[0], x_cur[1], x_cur[2], u[0], u[1], u[2], r[0],
        r[1], r[2]);
  }
  table.write(path);
}

void write_cables(const std::string& path, const model::Model& model, const model::Response& response) {
  require_size(path, "cable results", response.cables.size(), model.cables.size());
  Table table("id,group,node_1,node_2,length,unstressed_length,tension,slack");
  const auto groups = group_cells(model);
  for (std::size_t i = 0; i < model.cables.size(); ++i) {
    const auto& cable = model.cables[i];
    const auto& result = response.cables[i];
    table.row("{},{},{},{},{:.17g},{:.17g},{:.17g},{:d}", i + 1,
              groups[static_cast<std::size_t>(cable.group)], cable.nodes[0] + 1, cable.nodes[1] + 1,
              result.length, model.unstressed_length(cable), result.tension, result.slack);
  }
  table.write(path);
}

void write_beams(const std::string& path, const model::Model& model, const model::Response& response) {
  require_size(path, "beam results", response.beams.size(), model.beams.size());
  Table table(
      "id,group,node_1,node_2,axial,shear_2,shear_3,torque,moment_2_start,moment_3_start,moment_2_end,moment_"
      "3_end,axial_start,shear_2_start,shear_3_start");
  const auto groups = group_cells(model);
  for (std::size_t i = 0; i < model.beams.size(); ++i) {
    const auto& beam = model.beams[i];
    const auto& f = response.beams[i];
    const Vec3 start = model::first_end_force(model, response, i);
    table.row(
        "{},{},{},{},{:.10g},{:.10g},{:.10g},{:.10g},{:.10g},{:.10g},{:.10g},{:.10g},{:.10g},{:.10g},{:.10g}",
        i + 1, groups[static_cast<std::size_t>(beam.group)], beam.nodes[0] + 1, beam.nodes[1] + 1, f.axial,
        f.shear[0], f.shear[1], f.torque, f.end_moment(1, 0), f.end_moment(2, 0), f.end_moment(1, 1),
        f.end_moment(2, 1), start[0], start[1], start[2]);
  }
  table.write(path);
}

namespace {

const char* name_of(element::MembraneState state) {
  constexpr const char* names[] = {"taut", "wrinkled", "slack"};
  return names[static_cast<int>(state)];
}

std::string node_cells(const model::FacetNodes& n) {
  return fmt::format("{},{},{},{}", n[0] + 1, n[1] + 1, n[2] + 1,
                     n.size() == 4 ? std::to_string(n[3] + 1) : "");
}

}  // namespace

void write_membranes(const std::string& path, const model::Model& model, const model::Response& response) {
  require_size(path, "membrane results", response.membranes.size(), model.membranes.size());
  Table table("id,group,node_1,node_2,node_3,node_4,principal_1,principal_2,state");
  const auto groups = group_cells(model);
  for (std::size_t i = 0; i < model.membranes.size(); ++i) {
    const auto& membrane = model.membranes[i];
    const auto& result = response.membranes[i];
    table.row("{},{},{},{:.10g},{:.10g},{}", i + 1, groups[static_cast<std::size_t>(membrane.group)],
              node_cells(membrane.nodes), result.principal_cauchy[0], result.principal_cauchy[1],
              name_of(result.state));
  }
  table.write(path);
}

void write_shells(const std::string& path, const model::Model& model, const model::Response& response) {
  require_size(path, "shell results", response.shells.size(), model.shells.size());
  Table table("id,group,node_1,node_2,node_3,node_4,n11,n22,n12,m11,m22,m12,q1,q2");
  const auto groups = group_cells(model);
  for (std::size_t i = 0; i < model.shells.size(); ++i) {
    const auto& f = response.shells[i];
    table.row("{},{},{},{:.10g},{:.10g},{:.10g},{:.10g},{:.10g},{:.10g},{:.10g},{:.10g}", i + 1,
              groups[static_cast<std::size_t>(model.shells[i].group)], node_cells(model.shells[i].nodes),
              f.membrane[0], f.membrane[1], f.membrane[2], f.moment[0], f.moment[1], f.moment[2], f.shear[0],
              f.shear[1]);
  }
  table.write(path);
}

std::string csv_cell(const std::string& text) {
  const bool is_number = !text.empty() && text.find_first_not_of("0123456789.eE+-") == std::string::npos &&
                         text.find_first_of("0123456789") != std::string::npos;
  const bool is_formula = !text.empty() && std::strchr("=+-@\t\r", text.front()) != nullptr && !is_number;
  if (!is_formula && text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string quoted = is_formula ? "\"'" : "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

void write_columns(const std::string& path, const std::vector<std::string>& header,
                   const std::vector<std::vector<double>>& columns) {
  require_size(path, "columns", columns.size(), header.size());
  for (const auto& column : columns) require_size(path, "rows", column.size(), columns.front().size());
  Table table(fmt::format("{}", fmt::join(header, ",")));
  for (std::size_t i = 0; !columns.empty() && i < columns.front().size(); ++i) {
    std::vector<std::string> cells;
    for (const auto& column : columns)
      cells.push_back(std::isnan(column[i]) ? "" : fmt::format("{:.17g}", column[i]));
    table.row("{}", fmt::join(cells, ","));
  }
  table.write(path);
}

void write_springs(const std::string& path, const model::Model& model, const model::Response& response) {
  require_size(path, "spring results", response.springs.size(), model.springs.size());
  Table table("id,group,node_1,node_2,fx,fy,fz,mx,my,mz");
  const auto groups = group_cells(model);
  for (std::size_t i = 0; i < model.springs.size(); ++i) {
    const auto& spring = model.springs[i];
    const auto& r = response.springs[i];
    const std::string second = spring.grounded() ? "" : std::to_string(spring.nodes[1] + 1);
    table.row("{},{},{},{},{:.10g},{:.10g},{:.10g},{:.10g},{:.10g},{:.10g}", i + 1,
              groups[static_cast<std::size_t>(spring.group)], spring.nodes[0] + 1, second, r.force[0],
              r.force[1], r.force[2], r.moment[0], r.moment[1], r.moment[2]);
  }
  table.write(path);
}

void write_reactions(const std::string& path, const model::Model& model, const Points& force,
                     const Points& moment) {
  require_size(path, "reactions", force.size(), model.nodes.size());
  Table table("node,fx,fy,fz,mx,my,mz");
  for (std::size_t i = 0; i < force.size(); ++i)
    if (!force[i].isZero(0) || !moment[i].isZero(0))
      table.row("{},{:.10g},{:.10g},{:.10g},{:.10g},{:.10g},{:.10g}", i + 1, force[i][0], force[i][1],
                force[i][2], moment[i][0], moment[i][1], moment[i][2]);
  table.write(path);
}

void write_cut_list(const std::string& path, const model::Model& model, const model::Response& response) {
  require_size(path, "cable results", response.cables.size(), model.cables.size());
  struct Cut {
    double unstressed_length = 0;
    double weighted_tension = 0;  ///< sum of tension times unstressed length over the segments
  };
  std::map<std::pair<int, int>, Cut> cuts;
  for (std::size_t i = 0; i < model.cables.size(); ++i) {
    const auto& cable = model.cables[i];
    if (model.groups[static_cast<std::size_t>(cable.group)].kind == model::ElementKind::bar) continue;
    const double length = model.unstressed_length(cable);
    auto& cut = cuts[{cable.group, cable.parent}];
    cut.unstressed_length += length;
    cut.weighted_tension += length * response.cables[i].tension;
  }
  Table table("id,group,unstressed_length,marking_tension");
  const auto groups = group_cells(model);
  for (const auto& [key, cut] : cuts)
    table.row("{},{},{:.17g},{:.17g}", key.second + 1, groups[static_cast<std::size_t>(key.first)],
              cut.unstressed_length, cut.weighted_tension / cut.unstressed_length);
  table.write(path);
}

}  // namespace tautline::output

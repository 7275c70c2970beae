#!/usr/bin/env bash
# Counts every #include of include/ and src/ against the table of modules in docs/architecture.md, so that the table stays
# true: who includes whom, only downwards, and which third-party headers where. Private headers (src/) stay in their module.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

find include src \( -name '*.hpp' -o -name '*.cpp' \) -print0 | sort -z | xargs -0 grep -nH '^ *# *include' /dev/null | LC_ALL=C awk -F: '
function trim(text) { gsub(/^[ `]+|[ `]+$/, "", text); return text }
function complain(text) { printf "%s:%s: %s: module %s %s\n", $1, $2, header, module, text; bad++ }

# The name under which the table knows a third-party header; "" for the standard library and POSIX, Eigen and fmt.
function library(name) {
  if (name ~ /^(petsc|mpi\.h)/) return "PETSc"
  if (name ~ /^slepc/) return "SLEPc"
  if (name ~ /^[sdcz]mumps/) return "MUMPS"
  if (name ~ /^metis/) return "METIS"
  if (name ~ /^gmsh/) return "gmsh"
  if (name ~ /^vtk/) return "VTK"
  if (name ~ /^(EGL|GL|GLES2)\//) return "EGL"
  if (name ~ /^CLI\//) return "CLI11"
  if (name ~ /^yaml-cpp\//) return "yaml-cpp"
  if (name ~ /^nlohmann\//) return "nlohmann-json"
  if (name ~ /^(Eigen|fmt|sys)\// || name ~ /^[a-z_0-9]+$/ || name ~ /^(dlfcn|fcntl|spawn|unistd)\.h$/) return ""
  return name
}

# One rule for one include; `target` is the module of the header included.
function check_module(target) {
  if (target == module) return
  if (public && header ~ /_options\.hpp$/ && may[module, "*_options.hpp"]) return
  if (!public) return complain("includes a private header of module " target)
  if (!may[module, target] && !may[module, "all below"]) return complain("may not include module " target)
  if (layer[target] >= layer[module]) complain("includes upwards: " target " is no lower layer")
}

BEGIN {
  while ((getline line < "docs/architecture.md") > 0) {
    if (split(line, cell, "|") < 7 || trim(cell[2]) !~ /^[0-9]$/) continue
    name = trim(cell[3]); layer[name] = trim(cell[2]); modules++
    n = split(cell[5], part, ","); for (i = 1; i <= n; i++) may[name, trim(part[i])] = 1
    n = split(cell[6], part, ","); for (i = 1; i <= n; i++) third[name, trim(part[i])] = 1
  }
}
{
  split($1, folder, "/"); module = folder[1] == "src" ? folder[2] : folder[3]
  header = $0; sub(/^[^<"]*[<"]/, "", header); sub(/[>"].*/, "", header)
  own_folder = $0 ~ /include *"/ ? $1 : ""; sub(/[^\/]*$/, "", own_folder)
  count++
  if (!(module in layer)) { complain("is not in the table of docs/architecture.md"); next }
  public = sub(/^tautline\//, "", header)
  split(header, part, "/")
  if (part[1] in layer) { check_module(part[1]); next }
  if (own_folder != "" && (getline line < (own_folder header)) >= 0) { close(own_folder header); next }
  if (own_folder != "" || public) { complain("includes a header that is not there"); next }
  if (library(header) != "" && !third[module, library(header)]) complain("may not include " library(header))
}
END {
  printf "layers: %d includes, %d modules, %d violations\n", count, modules, bad
  exit bad > 0 || modules == 0 || count == 0
}'

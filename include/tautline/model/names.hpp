#pragma once
/// @file
/// How messages call nodes and elements: by the deck's names, or by numbers from 1 where there are none.

#include <string>

#include <tautline/model/model.hpp>

namespace tautline::model {

/// node "top", or node 12 where the deck has no name for it.
std::string node_name(const Model& model, int node);
/// The same with its place: node "top" at (0, 0, 3).
std::string node_at(const Model& model, int node);
/// The same with the groups whose elements it belongs to: node "top" of "mast" at (0, 0, 3). Looks through
/// all elements.
std::string node_in_group(const Model& model, int node);

/// cable 3 of group "net", from node "a" to node "m"; numbered as in the tables, from 1 over all groups.
std::string element_name(const Model& model, const char* kind, std::size_t index, int group);
std::string cable_name(const Model& model, std::size_t cable);
std::string beam_name(const Model& model, std::size_t beam);

}  // namespace tautline::model

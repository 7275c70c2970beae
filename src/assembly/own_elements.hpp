#pragma once
/// @file
/// Loops over a rank's share of the elements, and what all matrices need.

#include <span>
#include <type_traits>
#include <vector>

#include <tautline/assembly/system.hpp>

#include "assembly/contribution.hpp"

namespace tautline::assembly {

/// Adds an element matrix, given in unknowns, without the rows and columns of held ones.
template <class Matrix>
void add_free(std::span<const int> blocks, Matrix& values, const std::vector<bool>& held,
              la::SymmetricMatrix& to) {
  for (std::size_t b = 0; b < blocks.size(); ++b)
    for (int c = 0; c < 3; ++c)
      if (held[static_cast<std::size_t>(3 * blocks[b] + c)]) {
        values.row(3 * static_cast<int>(b) + c).setZero();
        values.col(3 * static_cast<int>(b) + c).setZero();
      }
  to.add(blocks, values.data());
}

template <class Element, class Want>
auto System::answer(const model::State& state, const Element& element, Want want) const {
  if constexpr (std::is_same_v<Element, model::Cable>)
    if (!branches_.empty())
      return contribution(model_, state, element,
                          branches_[static_cast<std::size_t>(&element - model_.cables.data())], want);
  return contribution(model_, state, element, want);
}

template <class Visit>
void System::for_each_own(const Visit& visit) const {
  const auto each = [&](const auto& elements, const std::vector<int>& indices) {
    for (const int i : indices) visit(elements[static_cast<std::size_t>(i)]);
  };
  each(model_.cables, share_.cables);
  each(model_.beams, share_.beams);
  each(model_.membranes, share_.membranes);
  each(model_.shells, share_.shells);
  each(model_.springs, share_.springs);
  each(model_.masses, share_.masses);
}

template <class Visit>
void System::for_each_pressed(const Visit& visit) const {
  for (const int i : share_.membranes)
    if (const double p = now_.pressure[static_cast<std::size_t>(i)]; p != 0)
      visit(model_.membranes[static_cast<std::size_t>(i)].nodes, p);
  for (const int i : share_.shells)
    if (const double p = now_.pressure[model_.membranes.size() + static_cast<std::size_t>(i)]; p != 0)
      visit(model_.shells[static_cast<std::size_t>(i)].nodes, p);
}

}  // namespace tautline::assembly

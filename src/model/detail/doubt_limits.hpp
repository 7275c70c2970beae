#pragma once
/// @file
/// What is far outside any structure, and what is usual. Reasons: docs/adr/0024-doubts.md

namespace tautline::model::detail {

struct Range {
  double least = 0, most = 0;
};

constexpr Range usual_sound{300, 25e3};      ///< rubber and knitted cloth to diamond [m/s]
constexpr Range possible_sound{20, 50e3};    ///< [m/s]
constexpr Range usual_modulus{1e8, 1.3e12};  ///< soft plastics to diamond [Pa]
constexpr Range usual_density{300, 25e3};    ///< wood to osmium [kg/m^3]
constexpr double largest_modulus = 1e16;    ///< [Pa]; what is meant to be rigid may have a thousand diamonds'
constexpr double largest_density = 1e5;     ///< [kg/m^3]
constexpr double largest_expansion = 0.01;  ///< [1/K]
constexpr double largest_strain = 1;        ///< of members, initial or in equilibrium
constexpr double largest_turn = 1;          ///< of one end of a beam element against the other [rad]
constexpr double largest_cable = 3;         ///< diameter [m]; main cables of bridges have 1.1
constexpr double largest_beam = 100;        ///< [m]; cooling towers
constexpr double largest_wall = 30;         ///< thickness of shells [m]
constexpr double largest_cloth = 0.2;       ///< thickness of membranes [m]
constexpr double largest_structure = 5e3;   ///< [m]; spans of bridges reach 2 km
constexpr double largest_acceleration = 1e3;                        ///< [m/s^2]
constexpr double lowest_cooling = -293.15, highest_heating = 4000;  ///< [K]
constexpr double touching = 1e-3;      ///< distance of nodes over the shortest member there
constexpr double short_member = 1e-4;  ///< length over the median of all
constexpr double meeting = 1e-4;       ///< distance of axes over the shorter of two members

}  // namespace tautline::model::detail

#pragma once
/// @file
/// The texts behind `tautline new`, one source file (starting_<kind>.cpp) each.

namespace tautline::deck {

extern const char* const starting_perimeter_truss;
extern const char* const starting_umbrella;
extern const char* const starting_net;
extern const char* const starting_membrane;
extern const char* const starting_frame;
extern const char* const starting_rod_umbrella;

}  // namespace tautline::deck

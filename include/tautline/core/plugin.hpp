#pragma once
/// @file
/// Optional parts of the program that are loaded on first use, so that starting it stays quick.

#include <string>

namespace tautline {

/// @brief Address of an extern "C" function of a plugin; the plugin is loaded at its first call and stays for
/// the life of the process.
///
/// The plugin is looked for beside the executable, in plugins/, ../plugins/ and ../lib/tautline/.
/// @param[in] file    name of the library file, e.g. tautline_gmsh.so
/// @param[in] symbol  name of the function
/// @param[in] remedy  what to do if the plugin is not there or does not load, one sentence for the user
/// @throws LibraryError if it cannot be found or loaded, or lacks the function
void* load_plugin_symbol(const std::string& file, const std::string& symbol, const std::string& remedy);

}  // namespace tautline

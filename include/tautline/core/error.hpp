#pragma once
/// @file
/// The program's errors: each type is one meaning and one exit code (docs/architecture.md, "Errors").

#include <stdexcept>
#include <string>
#include <vector>

namespace tautline {

/// Exit codes of the executable.
enum class ExitCode : int {
  done = 0,
  bad_deck = 2,
  impossible_model = 3,
  not_converged = 4,
  library_failed = 5,
  bug = 70,
  interrupted = 130
};

/// A place in a text file; lines and columns count from 1, columns in characters. Line 0 means "no place
/// known".
struct SourceLocation {
  std::string file;
  int line = 0;
  int column = 0;
};

/// One complaint about a deck, complete in itself.
struct Diagnostic {
  SourceLocation where;
  std::string message;      ///< what was found, e.g. unknown material "stele"
  std::string source_line;  ///< the text of the line, for the caret display; may be empty
  int length = 1;           ///< characters under the caret
  std::string context;      ///< path in the deck, e.g. in sections.cord
  std::string expectation;  ///< what was expected, with unit and range; may be empty
  std::string suggestion;   ///< did-you-mean or remedy; may be empty
};

/// Text of a diagnostic as a user sees it: place, message, source line, caret, context, expectation,
/// suggestion.
std::string to_string(const Diagnostic& diagnostic);

/// The file is wrong. Holds every complaint found, in order of appearance. Exit code 2.
class DeckError : public std::runtime_error {
 public:
  explicit DeckError(std::vector<Diagnostic> diagnostics);
  const std::vector<Diagnostic>& diagnostics() const noexcept { return diagnostics_; }

 private:
  std::vector<Diagnostic> diagnostics_;
};

/// The file is well formed but the structure it describes is impossible. Exit code 3.
class ModelError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The analysis could not reach a state. Raised by steps only, after the last good state was saved. Exit
/// code 4.
class ConvergenceError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A library (PETSc, SLEPc, MUMPS, VTK, gmsh) or the file system failed. Exit code 5.
class LibraryError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The user asked to stop (Ctrl-C). Raised at the next safe point.
class Interrupted : public std::runtime_error {
 public:
  Interrupted() : std::runtime_error("interrupted by the user") {}
};

/// The text of `error` with "while <doing>" put after it, for adding context while unwinding.
std::string with_context(const std::string& error, const std::string& doing);

}  // namespace tautline

#pragma once
/// @file
/// The directory that a run writes its results to.

#include <set>
#include <string>
#include <vector>

namespace tautline::output {

/// @brief A directory of results while a run writes there: no other run may, and nothing that an earlier one
/// has left stands beside what is new.
///
/// The names of all files that a run writes are in DIRECTORY/.tautline_files before they are written, so that
/// the next run knows what to remove, also after a run that was killed. What users put there stays.
class RunDirectory {
 public:
  explicit RunDirectory(std::string directory) : directory_(std::move(directory)) {}
  ~RunDirectory();
  RunDirectory(const RunDirectory&) = delete;
  RunDirectory& operator=(const RunDirectory&) = delete;

  /// Creates the directory, locks it and removes what an earlier run has left; on one process of a run.
  /// @param goes_on the run takes up the one whose results are there: they stay
  /// @throws LibraryError if it cannot be written to, or another run writes there
  void open(bool goes_on);

  /// DIRECTORY/name of a file that is going to be written.
  std::string path(const std::string& name);

 private:
  void lock();
  std::set<std::string> listed() const;  ///< names of the files of earlier runs
  void sweep() const;                    ///< removes half-written files of runs that were killed
  void clear() const;

  std::string directory_;
  std::vector<std::string> names_;  ///< of this run so far
  int lock_ = -1, list_ = -1;       ///< descriptors
};

}  // namespace tautline::output

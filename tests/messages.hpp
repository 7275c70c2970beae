#pragma once
// Helpers for tests of error messages.

#include <gtest/gtest.h>

#include <string>

namespace tautline::testing_messages {

/// The message of the Error that `action` throws; a test failure if it throws none.
template <class Error, class Action>
std::string message_of(const Action& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  ADD_FAILURE() << "no such error was thrown";
  return "";
}

inline ::testing::AssertionResult mentions(const std::string& message, const std::string& part) {
  if (message.find(part) != std::string::npos) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << "\"" << part << "\" is missing in: " << message;
}

}  // namespace tautline::testing_messages

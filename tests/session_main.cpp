// Starts MPI and PETSc around the tests of a module that stands on them.

#include <gtest/gtest.h>

#include <tautline/la/session.hpp>

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  const tautline::la::Session session;
  return RUN_ALL_TESTS();
}

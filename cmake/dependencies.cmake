# Every third-party library the program stands on, as imported targets.
find_package(PkgConfig REQUIRED)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(fmt REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(yaml-cpp REQUIRED)
find_package(CLI11 REQUIRED)
find_package(VTK 9.1 REQUIRED COMPONENTS CommonCore CommonDataModel IOXML)
pkg_check_modules(PETSC REQUIRED IMPORTED_TARGET PETSc)
pkg_check_modules(SLEPC REQUIRED IMPORTED_TARGET SLEPc)
find_package(MPI REQUIRED COMPONENTS C)

add_library(tautline_petsc INTERFACE)
target_link_libraries(tautline_petsc INTERFACE PkgConfig::SLEPC PkgConfig::PETSC MPI::MPI_C)

find_path(METIS_INCLUDE_DIR metis.h REQUIRED)
find_library(METIS_LIBRARY metis REQUIRED)
add_library(tautline_metis INTERFACE)
target_include_directories(tautline_metis SYSTEM INTERFACE ${METIS_INCLUDE_DIR})
target_link_libraries(tautline_metis INTERFACE ${METIS_LIBRARY})

add_library(tautline_vtk INTERFACE)
target_link_libraries(tautline_vtk INTERFACE VTK::CommonCore VTK::CommonDataModel VTK::IOXML)

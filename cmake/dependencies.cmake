# Also installed, for find_package(remomask): what the libraries are linked with.
find_package(Threads REQUIRED)
find_package(Torch REQUIRED)
find_package(SQLite3 REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(OpenMP REQUIRED)
find_package(Eigen3 REQUIRED)
find_package(fmt REQUIRED)
find_package(PkgConfig REQUIRED)
pkg_check_modules(XXHASH REQUIRED IMPORTED_TARGET libxxhash)
pkg_check_modules(ARCHIVE REQUIRED IMPORTED_TARGET libarchive)
pkg_check_modules(TINYGLTF REQUIRED IMPORTED_TARGET tinygltf)
pkg_check_modules(ASSIMP REQUIRED IMPORTED_TARGET assimp)
pkg_check_modules(CAIRO REQUIRED IMPORTED_TARGET cairo)
pkg_check_modules(UTF8PROC REQUIRED IMPORTED_TARGET libutf8proc)

# Debian ships FAISS as a static library without CMake files; BLAS and LAPACK
# must follow it on the link line. The generic names keep the choice of
# update-alternatives.
find_path(FAISS_INCLUDE faiss/Index.h REQUIRED)
find_library(FAISS_LIBRARY faiss REQUIRED)
find_library(BLAS_LIBRARY blas REQUIRED)
find_library(LAPACK_LIBRARY lapack REQUIRED)
add_library(remomask_faiss INTERFACE IMPORTED)
target_include_directories(remomask_faiss INTERFACE ${FAISS_INCLUDE})
target_link_libraries(remomask_faiss INTERFACE
  ${FAISS_LIBRARY} ${LAPACK_LIBRARY} ${BLAS_LIBRARY} OpenMP::OpenMP_CXX)

add_library(remomask_torch INTERFACE IMPORTED)
target_include_directories(remomask_torch INTERFACE ${TORCH_INCLUDE_DIRS})
target_link_libraries(remomask_torch INTERFACE ${TORCH_LIBRARIES} OpenMP::OpenMP_CXX)

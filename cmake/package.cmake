# The Debian package: cpack -G DEB in the build folder.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME remomask)
set(CPACK_PACKAGE_CONTACT "remomask maintainers <remomask@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "text to human motion, with a searchable motion database")
set(CPACK_PACKAGE_DESCRIPTION
"Searches a database of human motions by the meaning of a sentence and uses what it finds to
generate new motions, edit given ones, and say where every result came from. With a trained
model, a database of motions, a C++ library and its headers.")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# libtorch is linked with whichever BLAS is chosen; the reference one is many times slower.
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS libopenblas0-pthread)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
include(CPack)

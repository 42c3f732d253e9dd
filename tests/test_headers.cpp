// Nothing: the tests' precompiled headers (tests/CMakeLists.txt) need a target, and a target needs a file.

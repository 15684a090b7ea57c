"""Conan recipe: `conan create cmake/conan`, in a checkout or in an unpacked archive of cmake/tarball.cmake."""

import os
from pathlib import Path

from conan import ConanFile
from conan.tools.cmake import CMake, CMakeToolchain, cmake_layout
from conan.tools.files import copy, load, rm, rmdir


class RicciConan(ConanFile):
    name = "ricci"
    description = "Discrete surface Ricci flow: conformal metrics of prescribed curvature on triangle meshes"
    license = "MIT OR Apache-2.0"
    package_type = "library"
    settings = "os", "arch", "compiler", "build_type"
    options = {"shared": [True, False]}
    default_options = {"shared": True}

    def set_version(self):
        manifest = load(self, Path(self.recipe_folder, "..", "..", "Cargo.toml"))
        self.version = next(line.split('"')[1] for line in manifest.splitlines() if line.startswith("version = "))

    def export_sources(self):
        # Cargo asks for the sources of everything that Cargo.toml names, built or not.
        tree = os.path.join(self.recipe_folder, "..", "..")
        for folder in ("src", "capi", "apps", "include", "cmake", "tests", "benches", "vendor", ".cargo"):
            copy(self, f"{folder}/*", tree, self.export_sources_folder)
        for file in ("Cargo.toml", "Cargo.lock", "CMakeLists.txt", "README.md", "LICENSE-*"):
            copy(self, file, tree, self.export_sources_folder)

    def layout(self):
        cmake_layout(self)

    def package_id(self):
        # C without a C++ runtime: one binary serves every compiler.
        del self.info.settings.compiler

    def generate(self):
        toolchain = CMakeToolchain(self)
        toolchain.cache_variables["RICCI_TESTS"] = False
        toolchain.cache_variables["RICCI_EXAMPLES"] = False
        toolchain.cache_variables["RICCI_CARGO_OFFLINE"] = os.path.isdir(os.path.join(self.source_folder, "vendor"))
        toolchain.generate()

    def build(self):
        cmake = CMake(self)
        cmake.configure()
        cmake.build()

    def package(self):
        CMake(self).install()
        copy(self, "LICENSE-*", self.source_folder, os.path.join(self.package_folder, "licenses"))
        libraries = os.path.join(self.package_folder, "lib")
        unwanted = ("libricci.a",) if self.options.shared else ("libricci.so*", "libricci*.dylib")
        for pattern in unwanted:
            rm(self, pattern, libraries)
        # Conan writes these for the consumer's build system.
        for folder in ("cmake", "pkgconfig"):
            rmdir(self, os.path.join(libraries, folder))

    def package_info(self):
        self.cpp_info.libs = ["ricci"]
        if not self.options.shared:
            self.cpp_info.defines = ["RICCI_STATIC"]
            if self.settings.os in ("Linux", "FreeBSD"):
                self.cpp_info.system_libs = ["pthread", "m", "dl"]

"""Conan recipe: `conan create cmake/conan` beside a source archive of cmake/tarball.cmake, or from this tree."""

import os

from conan import ConanFile
from conan.tools.cmake import CMake, CMakeToolchain, cmake_layout
from conan.tools.files import copy, load


class RicciConan(ConanFile):
    name = "ricci"
    description = "Discrete surface Ricci flow: conformal metrics of prescribed curvature on triangle meshes"
    license = "MIT OR Apache-2.0"
    settings = "os", "arch", "compiler", "build_type"
    options = {"shared": [True, False], "fPIC": [True, False]}
    default_options = {"shared": True, "fPIC": True}

    def set_version(self):
        manifest = load(self, os.path.join(self.recipe_folder, "..", "..", "Cargo.toml"))
        self.version = next(line.split('"')[1] for line in manifest.splitlines() if line.startswith("version = "))

    def export_sources(self):
        tree = os.path.join(self.recipe_folder, "..", "..")
        for folder in ("src", "capi", "include", "cmake", "vendor", ".cargo", "apps"):
            copy(self, f"{folder}/*", tree, self.export_sources_folder)
        for file in ("Cargo.toml", "Cargo.lock", "CMakeLists.txt", "README.md", "LICENSE-*"):
            copy(self, file, tree, self.export_sources_folder)

    def layout(self):
        cmake_layout(self)

    def generate(self):
        toolchain = CMakeToolchain(self)
        toolchain.variables["RICCI_TESTS"] = False
        toolchain.variables["RICCI_EXAMPLES"] = False
        toolchain.variables["RICCI_CARGO_OFFLINE"] = os.path.isdir(os.path.join(self.source_folder, "vendor"))
        toolchain.generate()

    def build(self):
        cmake = CMake(self)
        cmake.configure()
        cmake.build()

    def package(self):
        CMake(self).install()

    def package_info(self):
        self.cpp_info.set_property("cmake_file_name", "ricci")
        self.cpp_info.set_property("cmake_target_name", "ricci::ricci")
        self.cpp_info.set_property("pkg_config_name", "ricci")
        self.cpp_info.libs = ["ricci"]
        if not self.options.shared:
            self.cpp_info.system_libs = ["gcc_s", "pthread", "m", "dl"]

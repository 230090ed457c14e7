"""The package as a wheel: CMake compiles deflect._core, with what Debian's packages give and nothing downloaded.

DEFLECT_BUILD names the build folder; without it `build` of the checkout, where it was made for this Python, else
`build-python`, which is configured here. The module is linked with libraries of this machine: the wheel is for it alone.
"""

import atexit
import os
import pathlib
import re
import shutil
import subprocess
import sys
import sysconfig
import tempfile

from setuptools import Distribution, Extension, setup
from setuptools.command.build_ext import build_ext

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
GMSH = "deflect_gmsh.so"  # loaded where members are divided or a .msh is written
SUFFIX = sysconfig.get_config_var("EXT_SUFFIX")


def build_folder() -> pathlib.Path:
    if "DEFLECT_BUILD" in os.environ:
        return pathlib.Path(os.environ["DEFLECT_BUILD"]).resolve()
    usual = ROOT / "build"
    rules = usual / "build.ninja"
    made_for_this = rules.exists() and f"_core{SUFFIX}" in rules.read_text(errors="replace")
    return usual if made_for_this else ROOT / "build-python"


class ByCMake(build_ext):
    def build_extension(self, extension: Extension) -> None:
        build = build_folder()
        if not (build / "CMakeCache.txt").exists():
            subprocess.run(["cmake", "-S", str(ROOT), "-B", str(build), "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
                            "-DDEFLECT_TESTS=OFF", "-DDEFLECT_PYTHON=ON", f"-DPython_EXECUTABLE={sys.executable}"],
                           check=True)
        subprocess.run(["cmake", "--build", str(build), "--target", "deflect_python", "deflect_gmsh"], check=True)
        module = build / "python" / "deflect" / f"_core{SUFFIX}"
        if not module.exists():
            raise SystemExit(f"{build} was made for another Python than {sys.executable}: name another folder by "
                             "DEFLECT_BUILD, or remove it")
        target = pathlib.Path(self.get_ext_fullpath(extension.name))
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(module, target)
        shutil.copyfile(build / GMSH, target.parent / GMSH)


class WithModule(Distribution):
    def has_ext_modules(self) -> bool:
        return True


def data_files() -> list:
    """share/deflect below the prefix: devices, effects and frames, as `cmake --install` puts them."""
    folders = ("devices", "effects/catalogue", "cases", "frames")
    data = HERE.parent
    return [(f"share/deflect/{folder}", [os.path.relpath(f, HERE) for f in sorted((data / folder).glob("*.yaml"))])
            for folder in folders]


# Nothing is written beside this file.
scratch = tempfile.mkdtemp(prefix="deflect-")
atexit.register(shutil.rmtree, scratch, ignore_errors=True)
version = re.search(r"project\([^)]*VERSION\s+([\d.]+)", (ROOT / "CMakeLists.txt").read_text()).group(1)
setup(version=version, packages=["deflect"], package_data={"deflect": ["*.pyi", "py.typed"]}, data_files=data_files(),
      ext_modules=[Extension("deflect._core", [])], cmdclass={"build_ext": ByCMake}, distclass=WithModule,
      options={"build": {"build_base": scratch}, "egg_info": {"egg_base": scratch}})

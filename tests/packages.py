"""The form of what cannot be run here: packages.py scripts WORKFLOW... | packages.py recipe FOLDER."""

import subprocess
import sys
from pathlib import Path


def scripts(names):
    """Bash reads the scripts of workflows without running them."""
    import yaml

    for name in names:
        jobs = yaml.safe_load(Path(name).read_text(encoding="utf-8"))["jobs"]
        found = [step["run"] for job in jobs.values() for step in job["steps"] if "run" in step]
        assert found, f"{name} runs nothing"
        for script in found:
            subprocess.run(["bash", "-n"], input=script, text=True, check=True)


def recipe(folder):
    """The recipe can be rendered for three systems, each with the versions of Python that variants.yaml has."""
    import rattler_build

    for name in ("linux-64", "osx-arm64", "win-64"):
        platform = rattler_build.PlatformConfig(target_platform=name, build_platform=name, host_platform=name)
        variants = rattler_build.VariantConfig.from_file_with_context(
            folder / "variants.yaml", rattler_build.JinjaConfig(platform=platform)
        )
        made = rattler_build.Stage0Recipe.from_file(folder / "recipe.yaml").render(variants, rattler_build.RenderConfig(platform))
        assert len(made) == 3, f"{len(made)} packages for {name}"
        needed = made[0].recipe.to_dict()["requirements"]
        assert f"rust_{name}" in needed["build"], needed


if __name__ == "__main__":
    if sys.argv[1] == "scripts":
        scripts(sys.argv[2:])
    else:
        recipe(Path(sys.argv[2]))

"""Licence texts of the crates that the C face links: licences.py CARGO SOURCE OUTPUT."""

import json
import pathlib
import subprocess
import sys

cargo, source, output = sys.argv[1:]


def ask(*words):
    done = subprocess.run([cargo, *words, "--locked"], cwd=source, capture_output=True, text=True, check=True)
    return done.stdout


linked = ask("tree", "--package", "ricci-capi", "--edges", "normal", "--prefix", "none", "--format", "{p}")
names = {tuple(line.split()[:2]) for line in linked.splitlines() if line and "(/" not in line}
# Crates of other platforms may not have been fetched.
version = subprocess.run([cargo, "--version", "--verbose"], capture_output=True, text=True, check=True).stdout
host = next(line.split()[1] for line in version.splitlines() if line.startswith("host:"))
packages = json.loads(ask("metadata", "--format-version", "1", "--filter-platform", host))["packages"]
parts = []
for package in sorted(packages, key=lambda p: (p["name"], p["version"])):
    if (package["name"], "v" + package["version"]) not in names:
        continue
    folder = pathlib.Path(package["manifest_path"]).parent
    texts = sorted(f for f in folder.iterdir() if f.is_file() and f.name.upper().startswith(("LICENSE", "LICENCE", "COPYING", "UNLICENSE")))
    head = f"{package['name']} {package['version']}: {package['license'] or 'see below'}\n{package['repository'] or ''}"
    parts.append("\n\n".join([head, *(f.read_text(errors="replace").strip() for f in texts)]))
if len(parts) != len(names):
    sys.exit(f"{len(names)} crates are linked, {len(parts)} were found")
pathlib.Path(output).write_text(("\n\n" + "=" * 80 + "\n\n").join(parts) + "\n")
print(f"{len(parts)} licences")

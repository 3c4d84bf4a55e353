#!/usr/bin/env python3
"""Checks the direction of the includes.

The layers stand in docs/developer/architecture.md, in the block that begins with ```layers: one line per layer, the lowest first. Folders
that share a line do not know each other. This script reads every #include of a file of the project and fails on

- an arrow upwards: a file includes a file of a higher layer, or of another folder of its own layer;
- a cycle of files. A header and the source of the same name are one file here.

It names both files of every arrow upwards and all files of every cycle. Usage: scripts/check_layers.py [FOLDER]   (default: the project)
"""
import os
import re
import sys

public_headers = "include/musclesim/"
include_line = re.compile(r'^\s*#\s*include\s*"([^"]+)"')


def layers_of(document):
    """Folder -> number of its layer, from the ```layers block."""
    block = re.search(r"^```layers\n(.*?)^```", open(document, encoding="utf-8").read(), re.MULTILINE | re.DOTALL)
    if not block:
        sys.exit(f"{document}: there is no block that begins with ```layers")
    return {folder: number for number, line in enumerate(block.group(1).splitlines()) for folder in line.split("#")[0].split()}


def sources_below(folders):
    for top in [*folders, public_headers.rstrip("/")]:
        for folder, _, names in os.walk(top):
            yield from (f"{folder}/{name}" for name in names if name.endswith((".h", ".cpp")))


def place_of(path):
    """A public header has the place of its source."""
    return path.removeprefix(public_headers)


def layer_folder(path, layers):
    """The deepest folder of `path` that is a layer; None for the collective header and for what is generated."""
    folder = os.path.dirname(place_of(path))
    while folder and folder not in layers:
        folder = os.path.dirname(folder)
    return folder or None


def included_file(source, name):
    """Quoted includes are meant relative to the source, to include/ or to the project."""
    for start in (os.path.dirname(source), "include", "."):
        path = os.path.normpath(os.path.join(start, name))
        if os.path.isfile(path):
            return path
    return None  # generated


def arrows_of(source):
    with open(source, encoding="utf-8") as lines:
        for number, line in enumerate(lines, 1):
            if match := include_line.match(line):
                if target := included_file(source, match.group(1)):
                    yield number, target


def cycles_of(graph):
    """The strongly connected components of more than one file (Tarjan 1972)."""
    index, low, stack, on_stack, cycles = {}, {}, [], set(), []

    def visit(node):
        index[node] = low[node] = len(index)
        stack.append(node)
        on_stack.add(node)
        for target in sorted(graph.get(node, ())):
            if target not in index:
                visit(target)
                low[node] = min(low[node], low[target])
            elif target in on_stack:
                low[node] = min(low[node], index[target])
        if low[node] == index[node]:
            component = []
            while not component or component[-1] != node:
                component.append(stack.pop())
                on_stack.remove(component[-1])
            if len(component) > 1:
                cycles.append(sorted(component))

    sys.setrecursionlimit(10000)
    for node in sorted(graph):
        if node not in index:
            visit(node)
    return cycles


def main():
    os.chdir(sys.argv[1] if len(sys.argv) > 1 else os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
    layers = layers_of("docs/developer/architecture.md")
    tops = {folder for folder in layers if "/" not in folder}
    faults, graph, sources = [], {}, sorted(set(sources_below(tops)))
    for source in sources:
        own = layer_folder(source, layers)
        for number, target in arrows_of(source):
            unit, other = (os.path.splitext(place_of(path))[0] for path in (source, target))
            if unit != other:
                graph.setdefault(unit, set()).add(other)
            theirs = layer_folder(target, layers)
            if own is None or theirs is None or own == theirs:
                continue
            if layers[theirs] >= layers[own]:
                how = "upwards" if layers[theirs] > layers[own] else "sideways"
                faults.append(f"{source}:{number}: includes {target}: {how}, from {own} to {theirs}")
    faults += ["cycle of includes: " + ", ".join(cycle) for cycle in cycles_of(graph)]
    print(*faults, sep="\n" if faults else "")
    print(f"{len(sources)} files, {sum(map(len, graph.values()))} arrows between them, {len(faults)} faults")
    sys.exit(bool(faults))


if __name__ == "__main__":
    main()

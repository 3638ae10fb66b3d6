"""Tables of the races: reads FOLDER/<race>.jsonl as the races print them, prints Markdown, and with
--write FILE puts it into that file between the two marks, keeping what stands around them.

  report.py FOLDER [--compiler TEXT] [--write FILE] race...
"""
import argparse
import datetime
import json
import pathlib
import re
import subprocess

TITLES = {
    "compose": "Composition",
    "sampler": "Texture sampling",
    "bake": "Baking",
    "blender": "Baked models in Blender",
    "tangents": "Tangents",
    "maps": "Map tools",
    "render": "Rendering",
    "growth": "Growth",
}
BEGIN = "<!-- figures: written by scripts/bench -->"
END = "<!-- end of figures -->"


def number(value):
    if value is None or value != value:
        return "-"
    if abs(value) >= 1000:
        return f"{value:,.0f}"
    if abs(value) >= 100:
        return f"{value:.0f}"
    return f"{value:.3g}"


def span(ns, unit):
    """Nanoseconds in the unit that keeps them readable."""
    for size, name in ((1e9, "s"), (1e6, "ms")):
        if ns >= size:
            return f"{number(ns / size)} {name}"
    return f"{number(ns)} ns"


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    lines += ["| " + " | ".join(str(cell) for cell in row) + " |" for row in rows]
    return "\n".join(lines) + "\n"


def met(line):
    if "target" not in line:
        return "", ""
    bound = ("at most " if line["at_most"] else "at least ") + number(line["target"])
    value, target = line["value"], line["target"]
    if value != value:
        return bound, "not measured"
    if (value <= target) if line["at_most"] else (value >= target):
        return bound, "met"
    return bound, "missed by " + number(abs(value / target - 1) * 100) + " %"


def of(lines, kind):
    return [line for line in lines if line["kind"] == kind]


def method_of(race):
    """The comment at the head of the race's source says who runs and how."""
    source = (pathlib.Path(__file__).parent / f"{race}.cpp").read_text()
    words = []
    for line in source.splitlines():
        if not line.startswith("///"):
            break
        words.append(line[3:].strip())
    text = re.sub(r"\s+", " ", " ".join(words))
    return re.sub(r" (Peers?|Method) ", r"\n\n\1: ", text)


def section(race, lines):
    out = [f"### {TITLES[race]}\n", method_of(race) + "\n"]
    for line in of(lines, "absent"):
        out.append(f"**{line['peer']} took no part**: {line['reason']}.\n")
    times = of(lines, "time")
    if times:
        rows = [[t["case"], t["threads"], t["name"], span(t["cpu_ns"], t["unit"]), span(t["wall_ns"], t["unit"]),
                 f"{span(t['least_cpu_ns'], '')} - {span(t['most_cpu_ns'], '')}", t["unit"]] for t in times]
        out.append(table(["race", "threads", "who", "processor", "wall", "processor, best - worst", "for one"], rows))
    verdicts = [line for line in lines if line["kind"] in ("ratio", "value")]
    if verdicts:
        rows = []
        for line in verdicts:
            value = number(line["value"]) + ("x" if line["kind"] == "ratio" else " " + line["unit"])
            rows.append([line["case"], line["threads"], line["what"], value, *met(line)])
        out.append(table(["race", "threads", "figure", "value", "target", ""], rows))
    for case in dict.fromkeys(line["case"] for line in of(lines, "growth")):
        group = [line for line in of(lines, "growth") if line["case"] == case]
        rows = [[g["name"], *[number(ns) for ns in g["ns"]], number(g["one_more"])] for g in group]
        head = [f"{case}: processor ns a {group[0]['unit']}", *[str(x) for x in group[0]["x"]], "one more"]
        out.append(table(head, rows))
    for line in of(lines, "note"):
        out.append(f"- {line['text']}")
    return "\n".join(out) + "\n"


def summary(everything):
    rows = []
    for race, lines in everything.items():
        for line in lines:
            if "target" in line:
                value = number(line["value"]) + ("x" if line["kind"] == "ratio" else " " + line["unit"])
                rows.append([race, line["case"], line["threads"], line["what"], value, *met(line)])
    return table(["race", "case", "threads", "figure", "value", "target", ""], rows)


def machine():
    text = subprocess.run(["lscpu"], capture_output=True, text=True, check=False,
                          env={"LC_ALL": "C", "PATH": "/usr/bin:/bin"}).stdout
    facts = dict(line.split(":", 1) for line in text.splitlines() if ":" in line)
    facts = {key.strip(): value.strip() for key, value in facts.items()}
    caches = ", ".join(f"{name} {facts[name + ' cache']}" for name in ("L1d", "L2", "L3") if name + " cache" in facts)
    vector = [name for name in ("sse4_2", "avx2", "avx512f") if name in facts.get("Flags", "").split()]
    return (f"{facts.get('Model name', 'unknown processor')} (family {facts.get('CPU family', '?')}, model "
            f"{facts.get('Model', '?')}), {facts.get('CPU(s)', '?')} processors, {caches}; {', '.join(vector)}")


def main():
    arguments = argparse.ArgumentParser()
    arguments.add_argument("folder", type=pathlib.Path)
    arguments.add_argument("--compiler", default="unknown")
    arguments.add_argument("--write", type=pathlib.Path)
    arguments.add_argument("races", nargs="+")
    options = arguments.parse_args()
    everything = {}
    for race in TITLES:
        file = options.folder / f"{race}.jsonl"
        if race in options.races and file.exists():
            everything[race] = [json.loads(line) for line in file.read_text().splitlines()]
    text = "\n".join([
        f"Machine: {machine()}.  ", f"Compiler: {options.compiler}.  ",
        f"Date: {datetime.date.today().isoformat()}.\n", "## Targets\n", summary(everything), "## Races\n",
        *[section(race, lines) for race, lines in everything.items()]
    ])
    print(text)
    if options.write:
        page = options.write.read_text()
        before, rest = page.split(BEGIN)
        after = rest.split(END)[1]
        options.write.write_text(before + BEGIN + "\n\n" + text + "\n" + END + after)


if __name__ == "__main__":
    main()

"""Tables of shader costs: reads what shader_cost printed, prints Markdown, and puts it into PAGE between the two
marks, keeping what stands around them.

  shader_cost.py COSTS.jsonl PAGE
"""
import argparse
import datetime
import json
import pathlib

from report import met, table

# (shader, what it does, the peer that does the same)
ROWS = [
    ("tbn", "usual: TBN, 1 normal map", None),
    ("tbn_normalized", "usual: the same, N and T normalised first", "tbn"),
    ("normal_map", "**surfgrad**: 1 normal map", "tbn"),
    ("derivative_map", "**surfgrad**: 1 derivative map", "tbn"),
    ("rnm_2", "usual: TBN, 2 normal maps blended by RNM", None),
    ("normal_maps_2", "**surfgrad**: 2 normal maps on one UV set", "rnm_2"),
    ("rnm_3", "usual: TBN, 3 normal maps blended by RNM", None),
    ("rnm_3_regrouped", "usual: the same, RNM regrouped by hand", "rnm_3"),
    ("normal_maps_3", "**surfgrad**: 3 normal maps on one UV set", "rnm_3"),
    ("cotangent_frame", "usual: Schueler's cotangent frame, 1 normal map", None),
    ("derived_basis", "**surfgrad**: 1 normal map, derived basis", "cotangent_frame"),
    ("second_set", "**surfgrad**: 1 normal map, and 1 on a second UV set with a derived basis", None),
    ("triplanar_whiteout", "usual: triplanar, whiteout blending", None),
    ("triplanar", "**surfgrad**: triplanar", "triplanar_whiteout"),
    ("decals_4", "**surfgrad**: 1 normal map and 4 box decals", None),
]
# Instructions of the first over those of the second.
TARGETS = [
    ("normal_map", "tbn", 1.3),
    ("derivative_map", "tbn", 1.0),
    ("normal_maps_3", "rnm_3", 1.0),
    ("normal_maps_3", "rnm_3_regrouped", 1.0),
]
FIGURES = [("Instructions", "instructions"), ("VGPRs", "VGPRs"), ("Inverse Throughput", "inverse throughput")]
BEGIN = "<!-- shader costs: written by scripts/shader-cost -->"
END = "<!-- end of shader costs -->"


def costs_table(costs, families):
    head = ["fragment shader"]
    for family in families:
        head += [f"{family}: {FIGURES[0][1]}", *[words for _, words in FIGURES[1:]], "of the peer's"]
    rows = []
    for shader, words, peer in ROWS:
        row = [words]
        for family in families:
            own = costs[family, shader]
            row += [own[name] for name, _ in FIGURES]
            row.append(f"{own['Instructions'] / costs[family, peer]['Instructions']:.2f}x" if peer else "")
        rows.append(row)
    return table(head, rows)


def targets_table(costs, families):
    words = {shader: text for shader, text, _ in ROWS}
    rows = []
    for shader, peer, most in TARGETS:
        for family in families:
            ratio = costs[family, shader]["Instructions"] / costs[family, peer]["Instructions"]
            line = {"value": ratio, "target": most, "at_most": True}
            rows.append([words[shader], words[peer], family, f"{ratio:.3f}x", *met(line)])
    return table(["instructions of", "over those of", "family", "ratio", "target", ""], rows)


def main():
    arguments = argparse.ArgumentParser()
    arguments.add_argument("costs", type=pathlib.Path)
    arguments.add_argument("page", type=pathlib.Path)
    options = arguments.parse_args()
    lines = [json.loads(line) for line in options.costs.read_text().splitlines()]
    costs = {(line["family"], line["shader"]): line["statistics"] for line in lines}
    families = list(dict.fromkeys(line["family"] for line in lines))
    without = {line["shader"] for line in lines} - {shader for shader, _, _ in ROWS}
    assert not without, f"ROWS lacks {', '.join(sorted(without))}"
    text = "\n".join([
        f"Compiler: RADV of {lines[0]['driver']}, as {' and '.join(families)}.  ",
        f"Date: {datetime.date.today().isoformat()}.\n",
        targets_table(costs, families),
        costs_table(costs, families),
    ])
    print(text)
    page = options.page.read_text()
    before, rest = page.split(BEGIN)
    after = rest.split(END)[1]
    options.page.write_text(before + BEGIN + "\n\n" + text + "\n" + END + after)


if __name__ == "__main__":
    main()

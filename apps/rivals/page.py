# SPDX-License-Identifier: Apache-2.0
"""The page of rivals, and the lines that a terminal gets."""
import html
import json
import pathlib
import string

HERE = pathlib.Path(__file__).resolve().parent
CLOCKS = {"wall": "by the clock on the wall", "processor": "of the processors, over their number"}


def processor_name():
    """Of Linux; None where it does not say."""
    try:
        lines = pathlib.Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        return None
    return next((line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")), None)


def text(report):
    style = (HERE.parent / "report" / "page.css").read_text(encoding="utf-8")
    data = json.dumps(report).replace("</", "<\\/")
    return _template("page.html").substitute(
        style=style, date=report["date"], machine=html.escape(report["machine"]), threads=report["threads"],
        samples=report["samples_per_pixel"], clock=CLOCKS[report["clock"]], verdict=html.escape(verdict(report)),
        scenes="\n".join(_scene(scene) for scene in report["scenes"]), data=data,
        commands="\n".join(f"<pre>{html.escape(command)}</pre>" for command in _commands(report)))


def summary(report):
    lines = [verdict(report)]
    for scene in report["scenes"]:
        lines.append(pathlib.Path(scene["scene"]).name)
        for result in scene["results"]:
            ratios = "  ".join(f"{key} {_ratio(scene, result, key):7.3g}" for key in ("E", "E_trim", "E_block"))
            lines.append(f"  {result['renderer']:22} {ratios}  (over Vernier's)")
        lines.extend(f"  {left['renderer']:22} {left['reason'].splitlines()[0]}" for left in scene["left_out"])
    return "\n".join(lines)


def verdict(report):
    """Where Vernier takes less time to the same error, and where it takes more."""
    wins = losses = 0
    worst = None
    for scene in report["scenes"]:
        for result in scene["results"][1:]:
            ratio = _ratio(scene, result, "E_trim")
            wins, losses = wins + (ratio > 1), losses + (ratio <= 1)
            if worst is None or ratio < worst[0]:
                worst = (ratio, result["renderer"], pathlib.Path(scene["scene"]).name)
    if not worst:
        return "Nothing to compare with was found."
    said = f"Of {wins + losses} comparisons Vernier takes less time to the same error (E_trim) in {wins} and more in {losses}. "
    kind = "Its worst" if worst[0] <= 1 else "Its closest"
    return said + f"{kind} is beside {worst[1]} in {worst[2]}, which takes {worst[0]:.2f} times Vernier's time."


def _template(name):
    return string.Template((HERE / name).read_text(encoding="utf-8"))


def _ratio(scene, result, key):
    return result[key] / scene["results"][0][key]


def _scene(scene):
    size = f"{scene['width']} × {scene['height']}"
    return _template("scene.html").substitute(
        scene=html.escape(pathlib.Path(scene["scene"]).name), size=size,
        rows="\n".join(_row(scene, result) for result in scene["results"]), remarks=_remarks(scene))


def _row(scene, result):
    cells = [html.escape(result["version"] if result["renderer"] == "Vernier" else
                         f"{result['renderer']}: {result['version']}")]
    cells += [f"{_ratio(scene, result, key):.3g}" for key in ("E", "E_trim", "E_block")]
    cells += [f"{result['relative_variance']:.3g}", f"{result['seconds']:.3g}", f"{result['memory'] / 1e6:.0f}"]
    cells.append(f"{result['mean']:.4f} ± {result['mean_error']:.4f}")
    return "<tr>" + "".join(f"<td>{cell}</td>" for cell in cells) + "</tr>"


def _remarks(scene):
    lines = []
    differ = [result["renderer"] for result in scene["results"] if not result["means_agree"]]
    if differ:
        lines.append(f"The mean of {', '.join(differ)} is another than Vernier's by more than 2 % and chance: its materials or "
                     "lights are not the same model. E is relative to its own mean.")
    elif len(scene["results"]) > 1:
        lines.append("All means agree to 2 % and chance.")
    lines += [f"{left['renderer']}: {left['reason']}" for left in scene["left_out"]]
    return "\n".join(f"<p>{html.escape(line)}</p>" for line in lines)


def _commands(report):
    yield report["command"]
    for scene in report["scenes"]:
        for result in scene["results"]:
            yield result["command"]

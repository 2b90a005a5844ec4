"""Figures as PDF, made by the build with the cargo feature `formats`."""

import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
# The build that .ci/clients makes for the exports.
HARNESS = ROOT / "target" / "debug" / "sil-harness"


@pytest.mark.skipif(not HARNESS.exists(), reason="not built: cargo build -p sil-harness --features formats")
def test_every_figure_has_a_pdf_beside_it(tmp_path):
    subprocess.run([HARNESS, "figures", "--pdf", "--out", tmp_path], check=True, capture_output=True)
    drawn = sorted(tmp_path.glob("*.svg"))
    assert len(drawn) == 6
    for svg in drawn:
        pdf = svg.with_suffix(".pdf").read_bytes()
        assert pdf.startswith(b"%PDF-") and pdf.rstrip().endswith(b"%%EOF"), svg.name
        # Its text is text, in a font that the file brings.
        assert b"/FontFile" in pdf and b"/ToUnicode" in pdf, svg.name

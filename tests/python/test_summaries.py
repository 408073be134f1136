# SPDX-License-Identifier: BSD-3-Clause
"""summary() and what notebooks show: a few lines, values to two digits of their u."""

import pickle
import re
import xml.etree.ElementTree as xml

import numpy as np
import pytest

import mmbrdf


@pytest.fixture(scope="module")
def things(ptfe, samples, tmp_path_factory):
    folder = tmp_path_factory.mktemp("summaries")
    goniometer = mmbrdf.Goniometer(1)
    goniometer.write_references(folder / "references.csv", 532)
    goniometer.write_raw(folder / "raw.csv", ptfe, 532, mmbrdf.in_plane(45, [0, 30]))
    instrument = mmbrdf.calibrate(folder / "references.csv", film=goniometer.film)
    instrument.save(folder / "instrument.json")
    turning = mmbrdf.Goniometer(3, dials_deg=mmbrdf.dial_angles(5, 6, 30), retardance_deg=127)
    turning.write_references(folder / "air.csv", 532)
    turning = mmbrdf.calibrate(
        folder / "air.csv", film=turning.film, dials_deg=mmbrdf.dial_angles(5, 6, 30), retardance_deg=127
    )
    u = 0.01 * np.concatenate([samples.f11[:, None], np.ones((len(samples), 15))], axis=1).reshape(-1, 4, 4)
    known = mmbrdf.Dataset(532, *samples.geometry, samples.mueller, uncertainty=u)
    few = mmbrdf.Dataset(532, 45, 0, [0, 30], 180, [[[0.3] + [float("nan")] * 3] + [[float("nan")] * 4] * 3] * 2)
    return {
        "model": ptfe,
        "one wavelength": mmbrdf.material("ptfe-532"),
        "published": mmbrdf.in_published_form(ptfe),
        "fit": mmbrdf.fit(samples),
        "weighted": mmbrdf.fit(known, weights="data"),
        "f11 alone": few,
        "samples": samples,
        "reduced": mmbrdf.reduce(folder / "raw.csv", instrument, solid_angle=goniometer.solid_angle),
        "instrument": instrument,
        "loaded": mmbrdf.load_instrument(folder / "instrument.json"),
        "turning": turning,
        "polarimeter": mmbrdf.ideal_states(["s", "p", "+45", "L"]),
    }


def test_each_is_a_few_lines_and_the_same_as_a_table(things):
    for name, thing in things.items():
        lines = thing.summary().splitlines()
        assert 2 < len(lines) < 24 and lines[0].startswith(f"mmbrdf.{type(thing).__name__}"), name
        assert all(len(line) < 160 for line in lines), name
        table = xml.fromstring(thing._repr_html_())
        rows = ["".join(row.itertext()) for row in table.iter("tr")]
        assert [re.sub(r"\s+", "", row) for row in rows] == [re.sub(r"\s+", "", line) for line in lines[1:]]
        assert not re.search(r"[1-9][\d.]{9}|nan|inf", thing.summary()), (name, thing.summary())


def test_numbers_have_two_digits_of_their_uncertainty(ptfe):
    text = ptfe.summary()
    found = re.search(r"532 nm +DHR\(8\) (\S+) ± (\S+), 0:45 (\S+) ± (\S+)", text)
    value, u = mmbrdf.directional_hemispherical_reflectance(ptfe, 532, 8, uncertainty=True)[:2]
    assert abs(float(found[1]) - value) < 0.005 * u * 10 and len(found[2].lstrip("0.")) == 2
    assert abs(float(found[2]) - u) < 0.05 * u
    factor = ptfe.reflectance_factor(532, 0, 0, 45, 0, uncertainty=True)
    assert abs(float(found[3]) - factor.value) < 0.05 * factor.u


def test_a_summary_says_what_there_is_to_know(things):
    assert "uncertainties  hold for the sample (k = 1)" in things["model"].summary()
    assert "not known" in things["published"].summary()
    assert "chi^2" not in things["fit"].summary() and "noise 0.0099 of f11" in things["fit"].summary()
    assert re.search(r"chi\^2 / dof +f11 [01]\.\d+, others [01]\.\d+", things["weighted"].summary())
    assert "12, 13, 14" in things["f11 alone"].summary() and "uncertainties  not known" in things["f11 alone"].summary()
    assert "raw.csv by references.csv" in things["reduced"].summary()
    for name in ("instrument", "loaded", "turning"):
        assert "figure of merit" in things[name].summary() and "u of the states" in things[name].summary()
    assert "generator_retardance_deg" in things["turning"].summary() and "±" in things["turning"].summary()


def test_names_are_text_in_html(samples):
    model = mmbrdf.fit(samples, name="<b>&").model
    assert "<b>" not in model._repr_html_() and "&lt;b&gt;&amp;" in model._repr_html_()


@pytest.mark.parametrize(
    "kind", [mmbrdf.Model, mmbrdf.FitResult, mmbrdf.Dataset, mmbrdf.Polarimeter, mmbrdf.Calibration]
)
def test_a_summary_can_be_sent_to_other_processes(kind):
    assert pickle.loads(pickle.dumps(kind.summary)) is kind.summary

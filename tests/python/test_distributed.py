# SPDX-License-Identifier: BSD-3-Clause
"""One fit of many files: the same bits by whoever fits, and what faults cost."""

import os
import signal
import threading
import time

import numpy as np
import pytest

import mmbrdf
from mmbrdf import distributed as archive

OPTIONS = {"orders": (2, 1), "uncertainty": "noise"}


@pytest.fixture(scope="module")
def files(ptfe, tmp_path_factory):
    """Seven, of different lengths and at two wavelengths."""
    folder = tmp_path_factory.mktemp("archive")
    paths = []
    for k in range(7):
        geometry = mmbrdf.random_geometries(150 + 20 * k, seed=k)
        paths.append(folder / f"run{k}.csv")
        mmbrdf.simulate(ptfe, 532 if k % 3 else 633, geometry, speckle=0.01, seed=k).save(paths[-1])
    return paths


def coefficients(fitted):
    return np.concatenate([block.coefficients.ravel() for block in fitted.result.model.blocks])


@pytest.fixture(scope="module")
def plain(files):
    return coefficients(archive.fit(files, **OPTIONS))


def test_files_fitted_together_are_one_fit(files, plain):
    one = mmbrdf.FitAccumulator(orders=OPTIONS["orders"])
    for path in files:
        one.add(mmbrdf.read_samples(path))
    fitted = archive.fit(files, **OPTIONS)
    assert fitted.samples == one.samples and fitted.skipped == {}
    expected = np.concatenate([block.coefficients.ravel() for block in one.solve().model.blocks])
    np.testing.assert_allclose(plain, expected, rtol=0, atol=1e-12 * np.abs(expected).max())


def test_the_tree_is_binary_over_the_order_of_the_files():
    tree = archive._tree(map(str, range(7)), lambda first, second: f"({first}{second})")
    assert tree == "(((01)(23))((45)6))"


def test_a_broken_file_is_named_and_left_out_only_if_that_was_asked(files, plain, tmp_path):
    broken = tmp_path / "broken.csv"
    broken.write_text("wavelength_nm,theta_i_deg\n532,x\n")
    missing = tmp_path / "missing.csv"
    some = [*files[:3], broken, *files[3:], missing]
    with pytest.raises(OSError, match="broken.csv"):
        archive.fit(some, **OPTIONS)
    fitted = archive.fit(some, skip_broken=True, **OPTIONS)
    assert sorted(fitted.skipped) == sorted(map(str, (broken, missing)))
    assert "missing.csv" in fitted.skipped[str(missing)]
    np.testing.assert_allclose(coefficients(fitted), plain, rtol=0, atol=1e-12 * np.abs(plain).max())
    with pytest.raises(ValueError, match="none of 1 can be read; the first: .*missing.csv"):
        archive.fit([missing], skip_broken=True, **OPTIONS)
    with pytest.raises(ValueError, match="files: none"):
        archive.fit([], **OPTIONS)


def test_another_call_continues_with_what_was_finished(files, plain, tmp_path, monkeypatch):
    read, asked = archive.read_samples, []

    def failing(path, **options):
        asked.append(os.fspath(path))
        if len(asked) == 5:
            raise KeyboardInterrupt
        return read(path, **options)

    monkeypatch.setattr(archive, "read_samples", failing)
    with pytest.raises(KeyboardInterrupt):
        archive.fit(files, checkpoint=tmp_path, **OPTIONS)
    assert len(list(tmp_path.iterdir())) == 4
    fitted = archive.fit(files, checkpoint=tmp_path, **OPTIONS)
    assert asked[5:] == [os.fspath(path) for path in files[4:]]
    np.testing.assert_array_equal(coefficients(fitted), plain)


@pytest.mark.parametrize(
    "option",
    [{"frame": "scattering_plane"}, {"convention": "p_first_right"}, {"columns": {"m22": "m33", "m33": "m22"}}],
    ids=lambda o: next(iter(o)),
)
def test_files_that_are_read_otherwise_are_not_those_of_the_checkpoints(files, tmp_path, option):
    some = files[:2]
    before = coefficients(archive.fit(some, checkpoint=tmp_path, **OPTIONS))
    expected = coefficients(archive.fit(some, **option, **OPTIONS))
    assert not np.array_equal(expected, before)
    found = coefficients(archive.fit(some, checkpoint=tmp_path, **option, **OPTIONS))
    np.testing.assert_array_equal(found, expected)
    again = {"columns": dict(reversed(option["columns"].items()))} if "columns" in option else option
    archive.fit(some, checkpoint=tmp_path, **again, **OPTIONS)
    assert len(list(tmp_path.iterdir())) == 4  # two states of two files


def test_unknown_options_are_refused_whatever_the_checkpoints(files, tmp_path):
    archive.fit(files[:2], checkpoint=tmp_path, **OPTIONS)
    with pytest.raises(
        TypeError, match=r"^distributed.fit: 'colums': not an option of it, nor of read_samples\(\): columns, "
    ):
        archive.fit(files[:2], checkpoint=tmp_path, colums={"f11": "f22"}, skip_broken=True, **OPTIONS)


def test_those_who_write_the_same_state_at_once_do_not_disturb_each_other(tmp_path):
    state, saved = np.arange(100_000.0), tmp_path / "state.npy"
    together, failed = threading.Barrier(8), []

    def write():
        together.wait()
        try:
            for _ in range(5):
                archive._save(state, saved)
        except OSError as error:
            failed.append(error)

    threads = [threading.Thread(target=write) for _ in range(8)]
    for one in threads:
        one.start()
    for one in threads:
        one.join()
    assert failed == [] and list(tmp_path.iterdir()) == [saved]


def test_one_file_is_taken_by_its_name(files):
    expected = coefficients(archive.fit(files[:1], **OPTIONS))
    for one in (files[0], str(files[0])):
        np.testing.assert_array_equal(coefficients(archive.fit(one, **OPTIONS)), expected)


def test_clients_and_orders_that_are_none_are_refused_in_a_line(files):
    with pytest.raises(TypeError, match=r"^client: expected a distributed.Client, not int$"):
        archive.fit(files, 3, **OPTIONS)
    with pytest.raises(ValueError, match=r"^orders = \(2,\), expected two whole numbers: of f11, and of the others$"):
        archive.fit(files, orders=(2,))


def test_a_file_that_is_there_twice_is_refused(files, tmp_path):
    with pytest.raises(ValueError, match=r"^files: number 2 \(.*run0.csv\) is number 0 \(.*run0.csv\) again"):
        archive.fit([*files[:2], files[0]], **OPTIONS)
    (tmp_path / "other.csv").symlink_to(files[0])
    with pytest.raises(ValueError, match=r"^files: number 1 \(.*other.csv\) is number 0"):
        archive.fit([files[0], tmp_path / "other.csv"], **OPTIONS)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no pipes with names")
def test_a_pipe_is_refused_by_fits_that_read_it_in_rounds(tmp_path):
    os.mkfifo(tmp_path / "pipe.csv")
    with pytest.raises(ValueError, match=r"^files: .*pipe.csv is a pipe, which can be read once: save it, or take "):
        archive.fit(tmp_path / "pipe.csv")


@pytest.mark.parametrize("damage", ["empty", "cut", "other", "flipped"])
def test_a_damaged_state_is_made_again_and_its_file_is_not_left_out(files, plain, tmp_path, damage):
    archive.fit(files, checkpoint=tmp_path, **OPTIONS)
    whole = {path: path.read_bytes() for path in tmp_path.iterdir()}
    assert len(whole) == len(files)
    for path, content in whole.items():
        middle = len(content) // 2
        flipped = content[:middle] + bytes([content[middle] ^ 1]) + content[middle + 1 :]
        path.write_bytes({"empty": b"", "cut": content[:middle], "other": b"wavelength_nm", "flipped": flipped}[damage])
    fitted = archive.fit(files, checkpoint=tmp_path, skip_broken=True, **OPTIONS)
    assert fitted.skipped == {}
    np.testing.assert_array_equal(coefficients(fitted), plain)
    assert {path: path.read_bytes() for path in tmp_path.iterdir()} == whole


def test_the_state_of_a_file_that_changes_while_it_is_read_is_not_kept(files, tmp_path, monkeypatch):
    """It would be that of the earlier file, for all who put that back."""
    changing, folder = tmp_path / "changing.csv", tmp_path / "states"
    changing.write_bytes(files[0].read_bytes())
    read = archive.read_samples

    def replaced_before(path, **options):
        changing.write_bytes(files[1].read_bytes())
        return read(path, **options)

    monkeypatch.setattr(archive, "read_samples", replaced_before)
    archive.fit(changing, checkpoint=folder, **OPTIONS)
    assert list(folder.iterdir()) == []


def test_nor_is_that_of_a_file_that_is_replaced_by_one_of_the_same_size_and_time(files, tmp_path, monkeypatch):
    changing, other, folder = tmp_path / "changing.csv", tmp_path / "other.csv", tmp_path / "states"
    changing.write_bytes(files[0].read_bytes())
    at = changing.stat()
    read = archive.read_samples

    def replaced_after(path, **options):
        samples = read(path, **options)
        other.write_bytes(changing.read_bytes().replace(b"1", b"2"))
        os.utime(other, ns=(at.st_atime_ns, at.st_mtime_ns))
        os.replace(other, changing)
        return samples

    monkeypatch.setattr(archive, "read_samples", replaced_after)
    archive.fit(changing, checkpoint=folder, **OPTIONS)
    assert (changing.stat().st_size, changing.stat().st_mtime_ns) == (at.st_size, at.st_mtime_ns)
    assert list(folder.iterdir()) == []


@pytest.mark.parametrize("skip_broken", [False, True])
def test_a_state_that_cannot_be_written_leaves_nothing_behind_nor_its_file_out(
    files, tmp_path, monkeypatch, skip_broken
):
    monkeypatch.setattr(os, "replace", lambda *_: (_ for _ in ()).throw(OSError(28, "No space left on device")))
    with pytest.raises(OSError, match=rf"^checkpoint {tmp_path}: No space left on device$"):
        archive.fit(files[:2], checkpoint=tmp_path, skip_broken=skip_broken, **OPTIONS)
    assert list(tmp_path.iterdir()) == []


# ---- fits of the sample, in rounds ----


@pytest.fixture(scope="module")
def few(files, tmp_path_factory):
    """Three, at two wavelengths, of which each has enough samples."""
    folder = tmp_path_factory.mktemp("few")
    paths = [folder / f"run{k}.csv" for k in range(3)]
    for k, path in enumerate(paths):
        mmbrdf.read_samples(files[k])[::3].save(path)
    return paths


@pytest.fixture(scope="module")
def sampled(few):
    return archive.fit(few, declared={"scale": 0.003})


def test_files_are_by_default_fitted_as_samples_in_memory_are(few, sampled, tmp_path):
    table = tmp_path / "all.csv"
    lines = [path.read_text().splitlines(keepends=True) for path in few]
    table.write_text("".join(lines[0] + [line for one in lines[1:] for line in one if line[0] not in "w#"]))
    expected = mmbrdf.fit(mmbrdf.read_samples(table), declared={"scale": 0.003})
    assert sampled.samples == len(mmbrdf.read_samples(table))
    assert sampled.result.model.provenance["uncertainty"] == "sample"
    assert sampled.result.model.provenance["weights"] == "speckle"
    for a, b in zip(sampled.result.model.blocks, expected.model.blocks, strict=True):
        np.testing.assert_allclose(a.coefficients, b.coefficients, rtol=0, atol=1e-7 * np.abs(b.coefficients).max())
    for wavelength in (532, 633):
        u, v = (fit.model.evaluate_uncertainty(wavelength, 30, 0, [0, 50], 120) for fit in (sampled.result, expected))
        np.testing.assert_allclose(u, v, rtol=1e-6)


def test_where_there_is_no_mixed_model_files_are_fitted_with_a_warning(few):
    fitted = archive.fit(few[:1], basis="germer2017", orders=(2, 1))
    assert fitted.result.model.provenance["uncertainty"] == "noise"
    assert fitted.result.warnings[0] == (
        "uncertainties are those of the noise alone: the germer2017 basis has no mixed model"
    )


def test_rounds_continue_with_what_was_finished(few, sampled, tmp_path, monkeypatch):
    read, asked = archive.read_samples, []

    def failing(path, **options):
        asked.append(os.fspath(path))
        if len(asked) == 8:
            raise KeyboardInterrupt
        return read(path, **options)

    monkeypatch.setattr(archive, "read_samples", failing)
    with pytest.raises(KeyboardInterrupt):
        archive.fit(few, declared={"scale": 0.003}, checkpoint=tmp_path)
    assert len(list(tmp_path.iterdir())) == 7  # of the third round one
    fitted = archive.fit(few, declared={"scale": 0.003}, checkpoint=tmp_path)
    assert asked[8:] == [os.fspath(path) for path in [*few[1:], *few]]
    np.testing.assert_array_equal(coefficients(fitted), coefficients(sampled))
    archive.fit(few, weights="none", checkpoint=tmp_path)
    assert len(list(tmp_path.iterdir())) == 12 + 9  # no second round without weights


def test_a_file_that_was_left_out_stays_so_and_one_that_changes_is_refused(few, sampled, tmp_path, monkeypatch):
    broken = tmp_path / "broken.csv"
    broken.write_text("wavelength_nm,theta_i_deg\n532,x\n")
    some = [broken, *few]
    read = archive.read_samples

    def mending(path, **options):
        result = read(path, **options)
        broken.write_text(few[0].read_text())
        return result

    monkeypatch.setattr(archive, "read_samples", mending)
    fitted = archive.fit(some, declared={"scale": 0.003}, skip_broken=True)
    assert list(fitted.skipped) == [str(broken)]
    np.testing.assert_array_equal(coefficients(fitted), coefficients(sampled))

    copies = [tmp_path / path.name for path in few]
    for path, copy in zip(few, copies):
        copy.write_bytes(path.read_bytes())

    def changing(path, **options):
        result = read(path, **options)
        if path == str(copies[2]):
            copies[0].write_text(few[1].read_text())
        return result

    monkeypatch.setattr(archive, "read_samples", changing)
    with pytest.raises(OSError, match=r"run0.csv: changed since the first round over the files; fit again$"):
        archive.fit(copies, skip_broken=True)


def test_a_file_with_other_samples_under_the_same_mark_is_refused_too(few, monkeypatch):
    read, asked = archive.read_samples, []

    def other(path, **options):
        asked.append(path)
        return read(few[1] if len(asked) > 3 and path == str(few[0]) else path, **options)

    monkeypatch.setattr(archive, "read_samples", other)
    with pytest.raises(
        ValueError,
        match=r"^files: round 2 was of other samples than round 1, \d+ of them in place of \d+: a file was changed, "
        r"but not its size and time$",
    ):
        archive.fit(few)


def test_a_state_of_a_file_that_was_changed_under_the_same_mark_is_told_from_its_folder(few, tmp_path):
    folder, copies = tmp_path / "states", [tmp_path / path.name for path in few]
    for path, copy in zip(few, copies):
        copy.write_bytes(path.read_bytes())
    archive.fit(copies, checkpoint=folder)
    at = copies[1].stat()
    copies[1].write_bytes(copies[1].read_bytes().replace(b"0.1", b"0.2"))
    os.utime(copies[1], ns=(at.st_atime_ns, at.st_mtime_ns))
    for path in folder.iterdir():  # of the first round one is there
        if np.load(path)[8] > 1:
            path.unlink()
    with pytest.raises(ValueError, match=rf"as many of them: .*, now or since its state was kept: empty {folder}$"):
        archive.fit(copies, checkpoint=folder)


def test_progress_sees_each_round(few):
    seen = []

    def progress(paths):
        seen.append(len(paths))
        return paths

    archive.fit(few, weights="none", progress=progress)
    assert seen == [3, 3, 3]


@pytest.mark.parametrize(
    "options, message",
    [
        ({"uncertainty": "both"}, "uncertainty 'both': must be 'sample' or 'noise'"),
        ({"uncertainty": "noise", "weights": "speckle"}, "weights 'speckle': with uncertainty='noise' files are "),
        ({"uncertainty": "noise", "declared": {"scale": 0.1}}, "declared: errors are declared of a sample"),
        ({"weights": "estimated"}, "weights estimated need all samples at once: take none or speckle"),
    ],
)
def test_what_files_cannot_be_fitted_with_is_refused(few, options, message):
    with pytest.raises(ValueError, match="^" + message):
        archive.fit(few, **options)


@pytest.mark.parametrize(
    "options, error, message",
    [
        (
            {"declared": {"scal": 0.1}},
            ValueError,
            "declared has no 'scal', only 'scale', 'source_deg' and 'receiver_deg'$",
        ),
        (
            {"reflectance": {532: "white"}},
            TypeError,
            "distributed.fit: reflectance: expected a dict {a number: a number}",
        ),
        ({"powers": 1.5}, TypeError, "distributed.fit: powers: expected a whole number, not float 1.5$"),
    ],
)
def test_what_cannot_be_solved_with_is_refused_before_anything_is_read(few, monkeypatch, options, error, message):
    monkeypatch.setattr(archive, "read_samples", lambda *_, **__: pytest.fail("read"))
    with pytest.raises(error, match="^" + message):
        archive.fit(few, **options)


def test_one_worker_and_two_give_the_bits_of_this_process_in_all_rounds(few, sampled, tmp_path):
    cluster_of = pytest.importorskip("distributed", reason="no distributed: ./dev packages clusters")
    for workers in (1, 2):
        with (
            cluster_of.LocalCluster(
                n_workers=workers, threads_per_worker=1, dashboard_address=None, local_directory=str(tmp_path / "dask")
            ) as cluster,
            cluster_of.Client(cluster) as client,
        ):
            fitted = archive.fit(few, client, declared={"scale": 0.003})
        np.testing.assert_array_equal(coefficients(fitted), coefficients(sampled))
        assert fitted.result.model.to_json() == sampled.result.model.to_json()


class _Held:
    """A plugin of the scheduler: the most tasks of which workers held what came out."""

    def __init__(self):
        self.now, self.most, self.names = set(), 0, set()

    def transition(self, key, start, finish, *_, **__):
        self.names.add(key)
        (self.now.add if finish == "memory" else self.now.discard)(key)
        self.most = max(self.most, len(self.now))


def test_workers_hold_few_states_at_once_whatever_the_number_of_files(few, tmp_path):
    """Half a dozen levels of a tree, and what runs; not the states of all files."""
    cluster_of = pytest.importorskip("distributed", reason="no distributed: ./dev packages clusters")
    many = [tmp_path / f"{k}_{path.name}" for k in range(40) for path in few]
    for k, path in enumerate(many):
        os.link(few[k % len(few)], path)
    held = type("Held", (_Held, cluster_of.SchedulerPlugin), {})()
    with (
        cluster_of.LocalCluster(
            n_workers=2, threads_per_worker=1, dashboard_address=None, local_directory=str(tmp_path / "dask")
        ) as cluster,
        cluster_of.Client(cluster) as client,
    ):
        cluster.scheduler.add_plugin(held)
        fitted = archive.fit(many, client, **OPTIONS)
    assert fitted.samples == 40 * archive.fit(few, **OPTIONS).samples
    assert 1 < held.most < 60
    for path in many:  # so that the error of one that kills workers says which it is
        assert sum(f"-{path.name}-" in name for name in held.names) == 1


def test_workers_and_workers_that_are_killed_leave_the_bits_as_they_are(files, plain, tmp_path):
    cluster_of = pytest.importorskip("distributed", reason="no distributed: ./dev packages clusters")
    many = [tmp_path / f"{k}_{path.name}" for k in range(40) for path in files]
    for k, path in enumerate(many):
        os.link(files[k % len(files)], path)
    with (
        cluster_of.LocalCluster(
            n_workers=2, threads_per_worker=1, dashboard_address=None, local_directory=str(tmp_path / "dask")
        ) as cluster,
        cluster_of.Client(cluster) as client,
    ):
        np.testing.assert_array_equal(coefficients(archive.fit(files, client, **OPTIONS)), plain)
        before = client.run(os.getpid)
        found = []
        # Many pieces, so that some run and some are done when a worker dies.
        work = threading.Thread(target=lambda: found.append(archive.fit(many, client, **OPTIONS)))
        work.start()
        time.sleep(0.3)
        os.kill(next(iter(before.values())), signal.SIGKILL)
        work.join(200)
        assert len(found) == 1
        expected = archive.fit(many, **OPTIONS)
        np.testing.assert_array_equal(coefficients(found[0]), coefficients(expected))
        assert found[0].samples == expected.samples


def test_a_worker_that_is_killed_in_each_round_leaves_the_bits_as_they_are(few, sampled, tmp_path):
    """It takes a piece that is done, what it made of others, and its copy of what the rounds before have found."""
    cluster_of = pytest.importorskip("distributed", reason="no distributed: ./dev packages clusters")
    killed = []
    with (
        cluster_of.LocalCluster(
            n_workers=2, threads_per_worker=1, dashboard_address=None, local_directory=str(tmp_path / "dask")
        ) as cluster,
        cluster_of.Client(cluster) as client,
    ):

        def killing(watched):
            for count, piece in enumerate(watched):
                holders = client.who_has([piece])[piece.key] if count == 0 else ()
                for worker in holders:
                    killed.append(client.run(os.getpid, workers=[worker])[worker])
                    os.kill(killed[-1], signal.SIGKILL)
                yield piece

        fitted = archive.fit(few, client, declared={"scale": 0.003}, progress=killing)
    assert len(set(killed)) >= 4  # one in each round
    assert fitted.result.model.to_json() == sampled.result.model.to_json()


def test_a_client_that_loses_its_scheduler_is_told_in_a_line(few, sampled, tmp_path):
    cluster_of = pytest.importorskip("distributed", reason="no distributed: ./dev packages clusters")
    with cluster_of.LocalCluster(processes=False, n_workers=1, threads_per_worker=1, dashboard_address=None) as cluster:
        client = cluster_of.Client(cluster)

        def losing(watched):
            yield next(iter(watched))
            cluster.close()

        with pytest.raises(
            ConnectionError, match="^client: lost its scheduler; with checkpoint= another call continues$"
        ):
            archive.fit(few, client, declared={"scale": 0.003}, checkpoint=tmp_path, progress=losing)
        client.close()
    fitted = archive.fit(few, declared={"scale": 0.003}, checkpoint=tmp_path)
    np.testing.assert_array_equal(coefficients(fitted), coefficients(sampled))


def test_a_client_that_is_asynchronous_is_refused(few):
    client = type("Client", (), {"asynchronous": True, "submit": print})()
    with pytest.raises(ValueError, match="^client: is asynchronous, and would not be waited for"):
        archive.fit(few, client)

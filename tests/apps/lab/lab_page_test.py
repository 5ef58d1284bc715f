#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""The lab page in a browser: controls, files, links, undo, designs. Exit 77: no browser.

    lab_page_test.py PAGE_OR_ENGINE    a page, or the engine as a program (lab_engine_cli)
"""

import base64
import json
import sys
import tempfile
import zlib
from pathlib import Path

PAGE = Path(sys.argv.pop(1))

from lab_browser import LabTest, run_tests  # noqa: E402

# Sets another valid value of a field, chosen by its type.
OTHER_VALUE = """
const node = document.querySelector(`[data-key="${args[0]}"] :is(input:not([type=range]), select)`);
const before = tofsmithLab.lab.camera.toml;
const field = tofsmithLab.lab.camera.fields.find((one) => one.key === args[0]);
if (field.type === 'boolean') node.click();
else if (field.type === 'choice') enter(node, field.choices.find((one) => one !== field.value));
else if (field.type === 'list') enter(node, '[2e3, 2e4]');
else if (field.type === 'text') enter(node, 'another');
else enter(node, String(field.value === field.usual[0] ? field.usual[1] : field.usual[0]));
await waitFor(() => tofsmithLab.lab.camera.toml !== before ||
    document.querySelector(`[data-key="${args[0]}"] .problem`).textContent);
return [tofsmithLab.lab.camera.toml !== before, document.querySelector(`[data-key="${args[0]}"] .problem`).textContent];
"""


class FirstPage(LabTest):
    """Tests that change nothing share a page."""

    is_open = False

    def setUp(self):
        if not FirstPage.is_open:
            super().setUp()
            FirstPage.is_open = True

    def test_all_views_of_a_code_are_shown(self):
        shown = self.run_script("""
            const area = (node) => { const b = node.getBoundingClientRect(); return b.width * b.height; };
            return Object.fromEntries(['waveforms', 'correlation', 'curve', 'map'].map((part) => [part,
              [...document.querySelectorAll(`[data-part=${part}] figure`)].map((f) => Math.min(...[...f.querySelectorAll('svg, canvas')].filter((n) => !n.closest('.legend')).map(area)))]));""")
        for part, areas in shown.items():
            self.assertEqual(len(areas), 2, part)
            self.assertGreater(min(areas), 1000, part)
        painted = self.run_script("""return [...document.querySelectorAll('.picture canvas, [data-part=curve] canvas')].map((canvas) =>
            new Set(canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data).size);""")
        self.assertEqual(len(painted), 8)
        self.assertGreater(min(painted), 5)
        self.assertRegex(self.text("#error-progress"), r"^\d+ trials$")

    def test_most_pixels_of_the_first_scene_are_ok(self):
        self.assertRegex(self.text("#scene-figures"), r"pixels with status ok: 9\d[.\d]* % unfiltered, (9|100)")

    def test_every_field_has_an_explanation(self):
        texts = self.run_script("return [...document.querySelectorAll('.field .doc')].map((doc) => doc.textContent);")
        self.assertGreater(len(texts), 20)
        for text in texts:
            self.assertGreater(len(text), 10)
            self.assertNotRegex(text, r"@|//|\bits\b|^its? ")

    def test_labels_do_not_repeat_the_unit(self):
        labels = self.run_script("return Object.fromEntries(tofsmithLab.lab.camera.fields.map(({key, label, unit}) => [key, [label, unit]]));")
        self.assertEqual(labels["operating.velocity_m_per_s"], ["velocity", "m/s"])
        self.assertEqual(labels["temperature.signal_per_c"], ["signal", "1/degree C"])
        self.assertEqual(labels["light.impulse_response.kind"], ["impulse response kind", ""])

    def test_every_control_and_plot_has_a_name(self):
        nameless = self.run_script("""
            return [...document.querySelectorAll('button, input, select, [tabindex="0"], canvas')].filter((node) => !node.closest('[hidden]') &&
              !(node.getAttribute('aria-label') || node.labels?.length || (node.tagName === 'BUTTON' && node.textContent.trim()))).map((node) => node.outerHTML.slice(0, 120));""")
        self.assertEqual(nameless, [])


class Page(LabTest):
    def test_plots_can_be_read_and_rotated_by_keys(self):
        said = self.run_script("""
            const press = (node, key) => { node.focus(); node.dispatchEvent(new KeyboardEvent('keydown', {key, bubbles: true, cancelable: true})); return byId('status').textContent; };
            const canvas = document.querySelector('[data-part=curve] canvas'), before = canvas.toDataURL();
            const heard = [press(document.querySelector('[data-part=correlation] .plot'), 'ArrowRight'), press(document.querySelector('[data-part=map] .plot'), 'ArrowRight'), press(document.querySelector('#error-curves .plot'), 'End')];
            press(canvas, 'ArrowLeft');
            await new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve)));
            return [...heard, canvas.toDataURL() !== before];""")
        self.assertRegex(said[0], r" m, 1: ")
        self.assertIn("error", said[1])
        self.assertIn("Cramer-Rao", said[2])
        self.assertTrue(said[3])

    def test_every_field_changes_the_camera_and_undo_restores_it(self):
        # With one code and few trials, each step draws less.
        self.run_script("tofsmithLab.store.change((state) => { state.codes.length = 1; state.trials = 100; }); await settled();")
        keys = self.run_script("return tofsmithLab.lab.camera.fields.filter((f) => f.value !== null && !f.expert).map((f) => f.key);")
        self.assertGreater(len(keys), 8)
        for key in keys:
            before = self.run_script("return tofsmithLab.lab.camera.toml;")
            changed, problem = self.run_script(OTHER_VALUE, key)
            if not changed:  # the camera may not support every value, but then the field reports
                             # why
                self.assertTrue(problem, key)
                continue
            self.run_script("byId('undo').click(); await waitFor(() => tofsmithLab.lab.camera.toml === args[0]);", before)

    def test_a_changed_field_is_in_every_command(self):
        self.run_script("enter(byId('field-light-peak_factor'), '7'); await settled();")
        commands = self.run_script("return [...document.querySelectorAll('.command pre')].map((p) => p.textContent);")
        self.assertEqual(len(commands), 4)
        for command in commands:
            self.assertRegex(command, r"--set '?light\.peak_factor=7")

    def test_a_slider_changes_the_picture_and_one_undo_reverts_the_whole_drag(self):
        first = self.run_script("""
            const slider = document.querySelector('[data-key="light.peak_factor"] input[type=range]');
            const picture = () => document.querySelector('[data-part=waveforms] svg').outerHTML;
            const before = picture();
            slider.focus();
            // The engine is slower than the hand: the last answer comes after the slider is let go.
            const call = tofsmithLab.engine.call.bind(tofsmithLab.engine);
            tofsmithLab.engine.call = async (name, ...rest) => {
              if (name === 'set') await new Promise((resolve) => setTimeout(resolve, 100));
              return call(name, ...rest);
            };
            for (const place of [300, 320, 340, 360]) {
              slider.value = place;
              slider.dispatchEvent(new Event('input', {bubbles: true}));
              await new Promise((resolve) => setTimeout(resolve, 60));
            }
            slider.dispatchEvent(new Event('change', {bubbles: true}));
            await waitFor(() => picture() !== before);
            await new Promise((resolve) => setTimeout(resolve, 400));
            await settled();
            byId('undo').click();
            await settled();
            return [tofsmithLab.store.state.camera.changes.length, picture() === before, byId('undo').disabled];""")
        self.assertEqual(first, [0, True, True])

    def test_every_other_control_changes_the_state(self):
        controls = {"camera-choice": "kinect-v2", "family-0": "square-k4", "trials": "1000", "seed": "5", "curve-ambient": "0",
                    "scene-name": "wall", "scene-filter": "strong", "scene-width": "80", "scene-signal": "2e5", "scene-ambient": "3e4"}
        for name, value in controls.items():
            self.assertTrue(self.run_script("""
                const before = JSON.stringify(tofsmithLab.store.state);
                enter(byId(args[0]), args[1]);
                return waitFor(() => JSON.stringify(tofsmithLab.store.state) !== before);""", name, value), name)
        state = self.state()
        self.assertEqual([state["camera"]["built_in"], state["trials"], state["seed"], state["curve_ambient"]], ["kinect-v2", 1000, 5, 0])
        self.assertEqual(state["scene"], {"name": "wall", "filter": "strong", "width": 80, "signal": 2e5, "ambient": 3e4})
        self.run_script("await settled(); byId('chosen-1').click(); byId('add-code').click(); await waitFor(() => byId('remove-2')); byId('remove-0').click(); await settled();")
        self.assertEqual(len(self.state()["codes"]), 2)
        self.assertEqual(self.text("#error-progress"), "1000 trials")
        self.run_script("byId('theme').click();")
        self.assertIn(self.driver.execute_script("return document.documentElement.dataset.theme"), ["light", "dark"])
        self.run_script("enter(byId('design-effort'), '1'); byId('fresh').click(); await settled();")
        self.assertEqual(self.state()["camera"]["built_in"], "indoor")

    def test_at_most_four_codes_are_shown_side_by_side(self):
        self.run_script("for (let i = 0; i < 5; ++i) { byId('add-code')?.click(); await settled(); }")
        self.assertEqual(len(self.state()["codes"]), 4)
        self.assertEqual(self.driver.execute_script("return document.querySelectorAll('[data-part=map] figure').length"), 4)

    def test_a_cell_of_the_map_sets_the_light_of_the_scene(self):
        self.run_script("""document.querySelector('[data-part=map] .cell:nth-of-type(2)').dispatchEvent(new MouseEvent('click', {bubbles: true})); await settled();""")
        self.assertIsNotNone(self.state()["scene"]["signal"])
        self.assertIn("signal", self.text("#scene-figures"))

    def test_edges_are_moved_by_pointer_and_keys_and_restored_by_undo(self):
        moved = self.run_script("""
            const node = document.querySelector('[data-part=waveforms] .plot');
            const edge = () => [...node.querySelectorAll('.edge')].find((e) => e.dataset.arm === 'gate' && e.dataset.k === '1' && e.dataset.edge === '1');
            const before = Number(edge().dataset.place), box = edge().querySelector('.grip').getBoundingClientRect();
            const at = (x) => ({clientX: x, clientY: box.y + 3, bubbles: true, pointerId: 1, cancelable: true});
            node.setPointerCapture = () => {};
            edge().querySelector('.grip').dispatchEvent(new PointerEvent('pointerdown', at(box.x)));
            for (const step of [5, 10, 20]) node.dispatchEvent(new PointerEvent('pointermove', at(box.x + step)));
            await settled();
            node.dispatchEvent(new PointerEvent('pointerup', at(box.x + 20)));
            const after = Number(edge().dataset.place);
            edge().focus();
            edge().dispatchEvent(new KeyboardEvent('keydown', {key: 'ArrowRight', bubbles: true, cancelable: true}));
            await settled();
            const keyed = Number(edge().dataset.place), isFocused = document.activeElement === edge();
            byId('undo').click();
            byId('undo').click();
            await settled();
            return [before, after, keyed, isFocused, Number(edge().dataset.place)];""")
        before, after, keyed, is_focused, again = moved
        self.assertGreater(after, before)
        self.assertGreater(keyed, after)
        self.assertTrue(is_focused)
        self.assertAlmostEqual(again, before)

    def test_an_edited_code_is_in_the_command_with_the_file_to_save(self):
        self.run_script("""
            const edge = document.querySelector('[data-part=waveforms] .edge');
            edge.focus();
            edge.dispatchEvent(new KeyboardEvent('keydown', {key: 'ArrowRight', bubbles: true, cancelable: true}));
            await settled();""")
        self.assertIn("hamiltonian-k4-edited.code.json", self.text("[data-command=evaluate] pre"))
        self.assertIn("First save from this page", self.text("[data-command=evaluate] .files"))

    def test_invalid_values_are_reported_at_the_field_and_the_picture_stays(self):
        for text in ("nan", "inf", "-1", "1e400", "five", ""):
            message, same = self.run_script("""
                const picture = document.querySelector('[data-part=waveforms] svg').outerHTML, state = JSON.stringify(tofsmithLab.store.state);
                enter(byId('field-light-peak_factor'), args[0]);
                const problem = byId('field-light-peak_factor-problem');
                await waitFor(() => !problem.hidden);
                await settled();
                const same = picture === document.querySelector('[data-part=waveforms] svg').outerHTML && state === JSON.stringify(tofsmithLab.store.state);
                const message = problem.textContent, invalid = byId('field-light-peak_factor').getAttribute('aria-invalid');
                enter(byId('field-light-peak_factor'), '4');
                await waitFor(() => problem.hidden);
                return [invalid && message, same];""", text)
            self.assertIn("peak_factor", message, text)
            self.assertTrue(same, text)
        for name in ("seed", "scene-signal"):
            self.run_script("enter(byId(args[0]), 'NaN');", name)
            self.assertEqual(self.driver.execute_script("return byId(arguments[0]).getAttribute('aria-invalid')", name), "true")

    def test_an_unknown_family_is_reported_at_its_code(self):
        self.run_script("enter(byId('family-0'), '?'); enter(byId('other-0'), '<img src=x onerror=alert(1)>'); await settled();")
        self.assertIn("<img", self.text(".slot .problem"))
        self.assertIn("last valid result", self.text("#error-table tbody tr"))
        self.assertEqual(self.driver.execute_script("return document.querySelectorAll('figure.pale').length"), 4)
        self.assertEqual(self.driver.execute_script("return document.querySelectorAll('main img').length"), 0)


class Files(LabTest):
    HOSTILE = {
        "empty.toml": "''", "zeros.json": "new Uint8Array(100)", "broken.json": "'{\"format\": '", "list.json": "'{\"a\": [[[[1]]]]}'",
        "latin.toml": "Uint8Array.of(110, 0xe4, 0xff)", "words.toml": "'hello world'", "deep.json": "'{\"a\":' + '['.repeat(100000)",
        "<img src=x>.toml": "'= = ='", "picture.png": "Uint8Array.of(137, 80, 78, 71, 13, 10, 26, 10, 0, 0)",
    }

    def test_hostile_files_are_rejected_by_name_and_change_nothing(self):
        for name, content in self.HOSTILE.items():
            message, same = self.run_script(f"""
                const before = JSON.stringify(tofsmithLab.store.state);
                byId('notice').hidden = true;
                dropped(new File([{content}], args[0]));
                await waitFor(() => !byId('notice').hidden);
                return [byId('notice').textContent, before === JSON.stringify(tofsmithLab.store.state)];""", name)
            self.assertIn(name, message)
            self.assertTrue(same, name)
        self.run_script("await settled();")

    def test_a_file_of_a_gigabyte_is_rejected_unread(self):
        with tempfile.TemporaryDirectory() as folder:
            big = Path(folder) / "big.toml"
            with big.open("wb") as file:
                file.truncate(10 ** 9)
            self.driver.execute_script("File.prototype.arrayBuffer = File.prototype.text = File.prototype.stream = () => { throw new Error('it was read'); };")
            self.driver.find_element("id", "files").send_keys(str(big))
            self.wait("!document.getElementById('notice').hidden")
        self.assertIn("found 1.0 GB; expected at most", self.text("#notice"))

    def test_a_camera_and_a_code_are_loaded_and_saved(self):
        self.run_script("""
            window.saved = [];
            URL.createObjectURL = ((make) => (blob) => { saved.push(blob); return make.call(URL, blob); })(URL.createObjectURL);
            HTMLAnchorElement.prototype.click = function () { saved.push(this.download); };
            byId('save-0').click();
            await waitFor(() => saved.length === 2);
            window.codeText = await saved[0].text();
            dropped(new File([codeText], 'mine.code.json'), new File(['fundamental_frequency_hz = 20e6\\n'], 'mine.toml'));
            await waitFor(() => tofsmithLab.store.state.camera.file_name === 'mine.toml' && tofsmithLab.store.state.codes.length === 3);
            await settled();
            byId('save-camera').click();
            await waitFor(() => saved.length === 4);""")
        self.assertEqual(self.state()["codes"][2]["name"], "hamiltonian-k4")
        self.assertEqual(self.driver.execute_script("return saved[3]"), "mine.toml")
        self.assertIn("--camera mine.toml", self.text("[data-command=evaluate] pre"))
        self.assertIn("20 MHz", self.text("#camera-summary"))
        self.assertEqual(self.run_script("byId('undo').click(); byId('undo').click(); await settled(); return tofsmithLab.store.state.codes.length;"), 2)


class Links(LabTest):
    def test_a_link_restores_the_state(self):
        link = self.run_script("""
            enter(byId('field-light-peak_factor'), '9');
            await settled();
            document.querySelector('[data-part=waveforms] .edge').dispatchEvent(new KeyboardEvent('keydown', {key: 'ArrowRight', bubbles: true, cancelable: true}));
            await settled();
            byId('link').click();
            await waitFor(() => byId('link').textContent !== 'Link');
            return location.hash;""")
        state = self.state()
        self.open(link)
        self.assertEqual(self.state(), state)
        self.assertEqual(self.driver.execute_script("return byId('field-light-peak_factor').value"), "9")

    def test_an_invalid_link_starts_with_the_default_and_a_message(self):
        def packed(state):
            squeezed = zlib.compressobj(9, zlib.DEFLATED, -15)
            data = squeezed.compress(json.dumps(state).encode()) + squeezed.flush()
            return "#1." + base64.urlsafe_b64encode(data).decode().rstrip("=")

        first = self.state()
        for fragment, word in (("#0.abc", "version 0"), ("#99.abc", "version 99"), ("#nonsense", "not a link"), ("#1.%00", "not a link"), ("#1.AAAA", "damaged"),
                               (packed({}), "damaged"), (packed({**first, "codes": []}), "its codes"), (packed({**first, "seed": None}), "its trials or seed"),
                               (packed({**first, "camera": {"built_in": "paper-10f0", "changes": "x" * 3000000}}), "damaged")):
            self.open(fragment, settle=False)
            self.wait("window.tofsmithLab && !document.getElementById('notice').hidden")
            self.assertIn(word, self.text("#notice"), fragment[:40])
            self.assertEqual(self.state(), first)

    def test_a_link_to_a_missing_camera_shows_a_message(self):
        self.run_script("tofsmithLab.store.change((state) => { state.camera.built_in = 'gone'; }); await settled();")
        self.assertIn("gone", self.text("#camera-error"))
        self.run_script("byId('undo').click(); await settled();")
        self.assertEqual(self.text("#camera-error"), "")


class UndoAndDesign(LabTest):
    def test_keys_undo_and_redo(self):
        values = self.run_script("""
            const press = (key, shiftKey = false) => document.body.dispatchEvent(new KeyboardEvent('keydown', {key, shiftKey, ctrlKey: true, bubbles: true, cancelable: true}));
            const peak = () => tofsmithLab.store.state.camera.changes.map((c) => c.value).join();
            const seen = [];
            for (const text of ['9', '11']) { enter(byId('field-light-peak_factor'), text); await settled(); }
            for (const [key, shift] of [['z', false], ['z', false], ['y', false], ['Z', true], ['z', false]]) { press(key, shift); seen.push(peak()); }
            await settled();
            return seen;""")
        self.assertEqual(values, ["9", "", "9", "11", "9"])

    def test_a_cancelled_design_changes_nothing(self):
        before, after = self.run_script("""
            const before = JSON.stringify(tofsmithLab.store.state);
            byId('design-start').click();
            await waitFor(() => document.querySelector('#design progress').value > 0 && byId('design-text').textContent);
            byId('design-cancel').click();
            await waitFor(() => !byId('design-start').disabled);
            await settled();
            return [before, JSON.stringify(tofsmithLab.store.state)];""")
        self.assertEqual(before, after)
        self.assertIn("cancelled", self.text("#design-text"))

    def test_a_design_is_added_to_the_codes(self):
        self.run_script("tofsmithLab.store.change((state) => { state.camera.changes = [{key: 'samples', value: '24'}, {key: 'exposure_s', value: '[3e-3, 3e-3, 3e-3]'}]; }); await settled();")
        self.run_script("byId('design-start').click(); await waitFor(() => tofsmithLab.store.state.codes.length === 3, 100); await settled();")
        self.assertIn("file", self.state()["codes"][2])
        self.assertEqual(self.driver.execute_script("return document.querySelectorAll('#error-table tbody tr').length"), 3)
        self.assertEqual(self.text(".slot:nth-child(3) .problem"), "")


class Readers(LabTest):
    def test_a_camera_of_three_taps_gets_a_known_code(self):
        offered, fitting = self.run_script("""
            const isOffered = () => byId('find-code').getClientRects().length > 0;
            const before = isOffered();
            enter(byId('field-sensor-taps'), '3');
            await waitFor(isOffered);
            byId('find-code').click();
            await waitFor(() => tofsmithLab.store.state.codes.length === 3);
            await settled();
            return [[before, isOffered()], tofsmithLab.lab.slots.slice(0, 3).map((slot) => !slot.problem)];""")
        self.assertEqual(offered, [False, False])
        self.assertEqual(fitting, [False, False, True])

    def test_a_browser_without_simd_gets_a_message(self):
        script = self.driver.execute_cdp_cmd("Page.addScriptToEvaluateOnNewDocument", {"source": "WebAssembly.validate = () => false;"})
        self.open(settle=False)
        self.wait("document.querySelector('.stop[role=alert]')")
        self.assertIn("SIMD", self.text(".stop[role=alert]"))
        self.driver.execute_cdp_cmd("Page.removeScriptToEvaluateOnNewDocument", script)


class Wide(LabTest):
    width = 1210  # three narrow columns: captions and legends differ in height

    def test_plots_in_a_row_are_aligned(self):
        tops = self.run_script("""
            tofsmithLab.store.change((state) => {
              state.trials = 100;
              state.codes = ['hamiltonian-k8', 'pulsed-multifrequency-k5', 'square-k4'].map((name) => ({name}));
            });
            await settled();
            return Object.fromEntries([...document.querySelectorAll('.columns')].map((row) => [row.dataset.part,
              [...row.querySelectorAll('.plot')].map((plot) => Math.round(plot.getBoundingClientRect().top))]));""")
        for part, heights in tops.items():
            self.assertEqual(len(heights), 3, part)
            self.assertEqual(len(set(heights)), 1, part)


class DarkPhone(LabTest):
    width, height, dark = 320, 640, True

    def test_nothing_exceeds_the_width_of_a_phone(self):
        self.run_script("for (const fold of document.querySelectorAll('details')) fold.open = true; for (let i = 0; i < 2; ++i) { byId('add-code').click(); await settled(); }")
        self.assertLessEqual(self.driver.execute_script("return document.documentElement.scrollWidth"), 320)
        wide = self.run_script("return [...document.querySelectorAll('body *')].filter((n) => n.getBoundingClientRect().right > 321 && !n.closest('.table, svg, .value, .skip, .quiet, [hidden]')).map((n) => n.outerHTML.slice(0, 100));")
        self.assertEqual(wide, [])
        self.assertEqual(self.driver.execute_script("return getComputedStyle(document.body).backgroundColor"), "rgb(20, 23, 27)")


if __name__ == "__main__":
    run_tests(PAGE)

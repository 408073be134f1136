# SPDX-License-Identifier: BSD-3-Clause
"""BiRD's own schema, by ajv, of an export in JSON, and its values between polarization states."""
import json
import pathlib
import tempfile

import numpy as np
import peer

import mmbrdf

DIGITS = 5e-8  # it has eight

VALIDATE = """
const fs = require('fs'), path = require('path');
const Ajv = require('ajv/dist/2020'), formats = require('ajv-formats');
const [schemas, file] = process.argv.slice(1);
const ajv = new Ajv({ strict: false });
formats(ajv);
for (const name of fs.readdirSync(schemas).filter((name) => name.endsWith('.json'))) {
  let schema;
  try { schema = JSON.parse(fs.readFileSync(path.join(schemas, name))); } catch { continue; }  // one of them is not JSON
  ajv.addSchema(schema);
}
const data = JSON.parse(fs.readFileSync(file)), validate = ajv.getSchema(data.metadata.schema);
if (!validate(data)) { console.error(JSON.stringify(validate.errors.slice(0, 3))); process.exit(1); }
console.log('ajv ' + require('ajv/package.json').version);
"""

def main():
    modules = pathlib.Path(*peer.command("MMBRDF_PEER_AJV", "a folder in which npm installed ajv and ajv-formats"))
    schemas = pathlib.Path(*peer.command("MMBRDF_PEER_BIRD", "the folder of BiRD's schemas")).resolve()
    model = mmbrdf.material("ptfe-532")
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "ptfe.brdf"
        model.export(file)
        version = peer.run(["node", "-e", VALIDATE, str(schemas), str(file)], cwd=modules).strip()
        data = {name: np.array(column["values"]) for name, column in json.loads(file.read_text())["data"].items()}
    chosen = np.random.default_rng(1).choice(len(data["BRDF"]), 1000, replace=False)
    data = {name: values[chosen] for name, values in data.items()}
    right = np.diag([1, 1, 1, -1])  # S4 > 0 is right-handed there
    angles = [data[name] for name in ("theta_i", "phi_i", "theta_r", "phi_r")]
    m = right @ model.evaluate(data["wavelength_i"], *angles, frame="sp") @ right
    light, analyzer = data["polarization_i"], data["polarization_r"]
    passed = np.where(analyzer[:, 1:].any(axis=1), 0.5, 1)  # an analyzer takes half of unpolarized light
    expected = passed * np.einsum("ni,nij,nj->n", analyzer, m, light)
    deviations = (data["BRDF"] - expected) / m[:, 0, 0]
    peer.judge(f"BiRD's schema v1.0, {version}", "valid; values between states", deviations, DIGITS, DIGITS)


main()

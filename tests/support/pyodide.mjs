// Run a script of Python in Pyodide under node: node pyodide.mjs FOLDER SCRIPT [ARGUMENT ...], where FOLDER is what
// `.ci/pyodide` has filled. The host's files are at /host; PYTHONPATH names folders there.
import { readdirSync, readFileSync } from "node:fs";

const [folder, script, ...words] = process.argv.slice(2);
const { loadPyodide } = await import(`file://${folder}/node_modules/pyodide/pyodide.mjs`);
const python = await loadPyodide({ args: ["-B", "-W", "error"] });
const wheel = readdirSync(folder).find((name) => /^numpy-.*\.whl$/.test(name));
python.unpackArchive(new Uint8Array(readFileSync(`${folder}/${wheel}`)), "wheel");
python.FS.mkdirTree("/host");
python.FS.mount(python.FS.filesystems.NODEFS, { root: "/" }, "/host");
const paths = process.env.PYTHONPATH.split(":");
python.runPython(`import sys\nsys.path[:0] = ${JSON.stringify(paths)}\nsys.argv = ${JSON.stringify([script, ...words])}`);
try {
  python.runPython(readFileSync(script, "utf8"));
} catch (error) {
  console.error(error.message);
  process.exit(1);
}

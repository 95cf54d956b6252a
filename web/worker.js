// The one worker: Python with camgeo. A message { id, call, input, files } is answered by { id, output, files } or
// { id, error }; while it begins it says how far it is, and a long call at which stage, { say }.
import { loadPyodide } from "./pyodide/pyodide.mjs";

const parameters = new URL(import.meta.url).searchParams;

async function bytes(name) {
  const answer = await fetch(new URL(name, import.meta.url));
  if (!answer.ok) throw new Error(`${name}: the server answers ${answer.status}`);
  return answer.arrayBuffer();
}

// a file while Python waits for it
function bytesNow(name) {
  const request = new XMLHttpRequest();
  request.open("GET", new URL(name, import.meta.url), false);
  request.responseType = "arraybuffer";
  request.send();
  if (request.status !== 200) throw new Error(`${name.split("?")[0]}: the server answers ${request.status}`);
  return request.response;
}

async function begin() {
  const say = (stage, share) => postMessage({ stage, share });
  const [numpy, code] = [bytes(parameters.get("numpy")), bytes(parameters.get("code"))];
  say("Python is coming", 0.05);
  const python = await loadPyodide();
  say("numpy is coming", 0.5);
  const packages = python.runPython("import site; site.getsitepackages()[0]");
  python.unpackArchive(await numpy, "zip", { extractDir: packages });
  say("camgeo is coming", 0.65);
  python.unpackArchive(await code, "zip", { extractDir: packages });
  say("camgeo is starting", 0.8);
  python.pyimport("later").install(() => {
    postMessage({ say: "what reads and writes files is coming" });
    python.unpackArchive(bytesNow(parameters.get("later")), "zip", { extractDir: packages });
  });
  const live = python.pyimport("live");
  live.say = (words) => postMessage({ say: words });
  const gc = python.pyimport("gc");
  gc.collect();
  gc.freeze(); // what is loaded stays: no collection looks at it again
  gc.set_threshold(100000); // one comes behind each answer, and none in the way of a picture
  say("", 1);
  return { python, live, gc };
}

const begun = begin();
begun.catch((error) => postMessage({ broken: String(error.message || error) }));

self.onmessage = async ({ data }) => {
  const { python, live, gc } = await begun;
  const { id, call, input, files = {} } = data;
  try {
    for (const name of python.FS.readdir(live.FOLDER)) {
      const path = `${live.FOLDER}/${name}`; // of a call before: no recipe finds a table that is not its own
      if (python.FS.isFile(python.FS.stat(path).mode)) python.FS.unlink(path);
    }
    for (const [name, content] of Object.entries(files)) python.FS.writeFile(`${live.FOLDER}/${name}`, content);
    const output = JSON.parse(live.answer(call, JSON.stringify(input)));
    const made = (output.files || []).map((file) => ({ ...file, bytes: python.FS.readFile(file.path) }));
    postMessage({ id, output, files: made }, made.map((file) => file.bytes.buffer));
    gc.collect();
  } catch (error) {
    postMessage({ id, error: String(error.message || error) });
  }
};

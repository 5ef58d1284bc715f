// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Worker of the lab page, appended to the script of the engine (tofsmithEngine). It starts with the
// message {start: WebAssembly.Module} and replies {ready: true}. It then processes {id, call, ...}
// one by one and replies {id, answer, arrays} or {id, error}, with {id, progress} in between.
"use strict";

const numberTypes = {Float32Array, Float64Array, Int32Array, Uint8Array};
let engine = null;
let currentId = null;
let reportedAt = 0;

/** Reports progress ten times per second. */
function tellProgress(fraction, text) {
  const now = Date.now();
  if (currentId === null || (now - reportedAt < 100 && fraction < 1)) return;
  reportedAt = now;
  self.postMessage({id: currentId, progress: {done: fraction, total: 1, text}});
}

function start(module) {
  return tofsmithEngine({
    onProgress: tellProgress,
    print: () => {},
    printErr: () => {},
    instantiateWasm(imports, done) {
      WebAssembly.instantiate(module, imports).then((instance) => done(instance, module));
      return {};
    },
  });
}

/** Returns the reply to a request: {answer, arrays} or {error}. */
function answer(request) {
  const text = JSON.stringify(request);
  const bytes = engine.lengthBytesUTF8(text) + 1;
  const place = engine._malloc(bytes);
  if (place === 0) return {error: {message: "this requires more memory than a web page can use"}};
  engine.stringToUTF8(text, place, bytes);
  let reply;
  try {
    reply = JSON.parse(engine.UTF8ToString(engine._tofsmith_lab_answer(place)));
  } finally {
    engine._free(place);
  }
  if (reply.error) return {error: reply.error};
  const arrays = {};
  for (const {name, type, pointer, length} of reply.arrays ?? []) {
    const Numbers = numberTypes[type];
    arrays[name] = new Numbers(engine.HEAPU8.buffer, pointer, length).slice();
  }
  return {answer: reply.answer, arrays};
}

self.onmessage = async ({data}) => {
  if (data.start) {
    try {
      engine = await start(data.start);
      self.postMessage({ready: true});
    } catch (error) {
      self.postMessage({error: {message: `the engine cannot start: ${error.message}`}});
    }
    return;
  }
  const {id, ...request} = data;
  currentId = id;
  let reply;
  try {
    reply = answer(request);
  } catch (error) {
    // Internal error: the engine may be in an invalid state, so the page starts another worker.
    reply = {error: {message: `the engine failed: ${error.message ?? error}`, fatal: true}};
  }
  currentId = null;
  self.postMessage({id, ...reply}, Object.values(reply.arrays ?? {}).map((array) => array.buffer));
};

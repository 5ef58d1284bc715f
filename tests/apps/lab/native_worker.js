// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Replacement for the worker and its WebAssembly in tests: passes each request to the engine that
// native_engine.py serves at ENGINE_ADDRESS, with the messages of worker.js.
'use strict';

function values({type, hex}) {
  const bytes = Uint8Array.from({length: hex.length / 2},
                                (_, i) => parseInt(hex.slice(2 * i, 2 * i + 2), 16));
  return new self[type](bytes.buffer);
}

self.onmessage = async ({data: {id, ...request}}) => {
  if ('start' in request) return self.postMessage({ready: true});
  const response = await fetch(ENGINE_ADDRESS, {method: 'POST', body: JSON.stringify(request)});
  const stream = response.body.pipeThrough(new TextDecoderStream()).getReader();
  for (let text = '', part; !(part = await stream.read()).done;) {
    const lines = (text + part.value).split('\n');
    text = lines.pop();
    for (const {arrays, ...reply} of lines.map((line) => JSON.parse(line)))
      self.postMessage({
        id,
        ...reply,
        ...(reply.progress ? {} : {arrays: Object.fromEntries(Object.entries(arrays ?? {}).map(([name, array]) => [name, values(array)]))})
      });
  }
};

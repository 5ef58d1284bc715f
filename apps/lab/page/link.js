// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// A state in the part of an address behind #: a version, a dot, and JSON, deflated, in base64url.

import {problemOf} from './store.js';

/** The version of links that this page writes; it reads no other. */
export const linkVersion = 1;

const maxLink = 1e5;   // characters: longer addresses are cut off by what they pass through
const maxState = 2e6;  // characters of JSON that are unpacked at most

async function through(bytes, stream) {
  return new Response(new Blob([bytes]).stream().pipeThrough(stream));
}

/** The state as text for an address, `#` included; null if it is too long for one. */
export async function linkOf(state) {
  const json = new TextEncoder().encode(JSON.stringify(state));
  const packed = new Uint8Array(
      await (await through(json, new CompressionStream('deflate-raw'))).arrayBuffer());
  if (packed.length > maxLink) return null;
  let binary = '';
  for (const byte of packed) binary += String.fromCharCode(byte);
  return `#${linkVersion}.` +
      btoa(binary).replaceAll('+', '-').replaceAll('/', '_').replaceAll('=', '');
}

async function limitedText(response) {
  const reader = response.body.pipeThrough(new TextDecoderStream()).getReader();
  let text = '';
  for (;;) {
    const {value, done} = await reader.read();
    if (done) return text;
    text += value;
    if (text.length > maxState) {
      await reader.cancel();
      throw new Error('too long');
    }
  }
}

/**
 * What a link says.
 * @returns {Promise<{state?: object, problem?: string}>} neither where there is no link
 */
export async function stateOf(hash) {
  if (hash.length < 2) return {};
  const found = /^#(\d+)\.([\w-]*)$/.exec(hash);
  if (!found) return {problem: 'This link is not one of the lab; it starts fresh.'};
  if (Number(found[1]) !== linkVersion)
    return {
      problem:
          `This link is of version ${found[1]}; this page reads ${linkVersion} and starts fresh.`
    };
  try {
    const binary = atob(found[2].replaceAll('-', '+').replaceAll('_', '/'));
    const bytes = Uint8Array.from(binary, (c) => c.charCodeAt(0));
    const state =
        JSON.parse(await limitedText(await through(bytes, new DecompressionStream('deflate-raw'))));
    const problem = problemOf(state);
    return problem ? {problem: `This link is damaged (${problem}); the lab starts fresh.`} :
                     {state};
  } catch {
    return {problem: 'This link is damaged or cut off; the lab starts fresh.'};
  }
}

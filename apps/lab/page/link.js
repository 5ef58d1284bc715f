// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// State in the fragment of a URL: a version, a dot, and deflated JSON in base64url.

import {problemOf} from './store.js';

/** Version of links; other versions are rejected. */
export const linkVersion = 1;

const maxLink = 1e5;   // characters; longer URLs may be truncated by other programs
const maxState = 2e6;  // maximum number of unpacked characters of JSON

async function through(bytes, stream) {
  return new Response(new Blob([bytes]).stream().pipeThrough(stream));
}

/** Returns the state as fragment of a URL, including `#`; null if it is too long. */
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
 * Decodes a link.
 * @returns {Promise<{state?: object, problem?: string}>} neither if there is no link
 */
export async function stateOf(hash) {
  if (hash.length < 2) return {};
  const found = /^#(\d+)\.([\w-]*)$/.exec(hash);
  if (!found)
    return {problem: 'This is not a link of the lab; the lab starts in its initial state.'};
  if (Number(found[1]) !== linkVersion)
    return {
      problem:
          `This link has version ${found[1]}; expected ${linkVersion}. The lab starts in its ` +
          'initial state.'
    };
  try {
    const binary = atob(found[2].replaceAll('-', '+').replaceAll('_', '/'));
    const bytes = Uint8Array.from(binary, (c) => c.charCodeAt(0));
    const state =
        JSON.parse(await limitedText(await through(bytes, new DecompressionStream('deflate-raw'))));
    const problem = problemOf(state);
    return problem ?
        {problem: `This link is damaged (${problem}); the lab starts in its initial state.`} :
        {state};
  } catch {
    return {problem: 'This link is damaged or truncated; the lab starts in its initial state.'};
  }
}

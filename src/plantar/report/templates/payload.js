"use strict";
// Decodes the page's data blocks: the inverse of plantar/report/payload.py.
const plantar = {};

(() => {
  const inflate = async (base64) => {
    const bytes = Uint8Array.from(atob(base64), (character) => character.charCodeAt(0));
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
    return new Uint8Array(await new Response(stream).arrayBuffer());
  };

  // Numbers of `width` bytes whose low bytes come first, then the next bytes, ...
  const planes = (bytes, start, count, width) => {
    const numbers = new Float64Array(count);
    for (let plane = width - 1; plane >= 0; plane--) {
      const from = start + plane * count;
      for (let i = 0; i < count; i++) numbers[i] = numbers[i] * 256 + bytes[from + i];
    }
    return numbers;
  };

  const readTime = (bytes, start, track) => {
    const time = planes(bytes, start, track.n, 4);
    let ticks = 0;
    for (let i = 0; i < track.n; i++) {
      ticks += time[i];
      time[i] = track.t0 + ticks * track.tick;
    }
    return time;
  };

  // null where a value was not finite, as uPlot wants it
  const readChannel = (bytes, start, track, channel) => {
    const changes = planes(bytes, start, track.n, 2);
    const values = new Array(track.n);
    let code = 0;
    for (let i = 0; i < track.n; i++) {
      const zigzag = changes[i];
      code = (code + (zigzag & 1 ? -(zigzag + 1) / 2 : zigzag / 2)) & 0xffff;
      values[i] = code === 0 ? null : channel.zero + (code - 1) * channel.step;
    }
    return values;
  };

  // The motion's tracks: {foot, time, used, air, values: {key: [..]}}; `air` is 1 where the foot is in the air.
  plantar.decode = async (header, base64) => {
    const bytes = await inflate(base64);
    let at = 0;
    return header.tracks.map((track) => {
      const time = readTime(bytes, at, track);
      at += 4 * track.n;
      const flags = bytes.subarray(at, at + track.n), inAir = header.supports.indexOf("air");
      const used = flags.map((flag) => flag & 1), air = flags.map((flag) => (flag >> 1 === inAir ? 1 : 0));
      at += track.n;
      const values = {};
      for (const channel of track.channels) {
        values[channel.key] = readChannel(bytes, at, track, channel);
        at += 2 * track.n;
      }
      return { foot: track.foot, time, used, air, values };
    });
  };
})();

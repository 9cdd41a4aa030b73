// Numbers as the report packs them: base64, deflate, bytes of equal weight together.

function bytesOf(text) {
  const binary = atob(text);
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < binary.length; ++i) bytes[i] = binary.charCodeAt(i);
  return bytes;
}

export async function unpack(text, Type) {
  const stream = new Blob([bytesOf(text)]).stream().pipeThrough(new DecompressionStream("deflate"));
  const shuffled = new Uint8Array(await new Response(stream).arrayBuffer());
  const size = Type.BYTES_PER_ELEMENT, count = shuffled.length / size;
  const bytes = new Uint8Array(shuffled.length);
  for (let b = 0; b < size; ++b) for (let k = 0; k < count; ++k) bytes[k * size + b] = shuffled[b * count + k];
  return new Type(bytes.buffer);
}

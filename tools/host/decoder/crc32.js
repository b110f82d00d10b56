// CRC-32/ISO-HDLC, that of zlib: crc32 of "123456789" is 0xCBF43926.

const TABLE = Uint32Array.from({ length: 256 }, (_, i) => {
  let r = i;
  for (let bit = 0; bit < 8; ++bit) r = (r >>> 1) ^ (r & 1 ? 0xedb88320 : 0);
  return r;
});

export function crc32(bytes) {
  let r = 0xffffffff;
  for (const byte of bytes) r = TABLE[(r ^ byte) & 0xff] ^ (r >>> 8);
  return ~r >>> 0;
}

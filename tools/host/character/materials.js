import { AdditiveBlending, MeshPhysicalMaterial, MeshStandardMaterial } from 'three';

export const SHELL = 0xe6ddcd;

// What the character is made of. A clear coat is dear: only what is large and looked at has one.
export function materials() {
  return {
    shell: new MeshPhysicalMaterial({ name: 'shell', color: SHELL, roughness: 0.42, clearcoat: 0.55, clearcoatRoughness: 0.22 }),
    lid: new MeshStandardMaterial({ name: 'lid', color: 0xcdb29c, roughness: 0.42 }),
    skin: new MeshPhysicalMaterial({ name: 'skin', color: 0xffffff, vertexColors: true, roughness: 0.46, clearcoat: 0.25, clearcoatRoughness: 0.3 }),
    blush: new MeshStandardMaterial({ name: 'blush', color: 0xe3bda8, roughness: 0.42 }),
    light: new MeshStandardMaterial({ name: 'light', color: 0x0b2b2c, emissive: 0x27d3cf, emissiveIntensity: 1.6 }),
    brow: new MeshStandardMaterial({ name: 'brow', color: 0x33241d, roughness: 0.6 }),
    graphite: new MeshStandardMaterial({ name: 'graphite', color: 0x24272b, roughness: 0.5, metalness: 0.55 }),
    rubber: new MeshStandardMaterial({ name: 'rubber', color: 0x17181a, roughness: 0.7 }),
    brass: new MeshStandardMaterial({ name: 'brass', color: 0xc8965a, roughness: 0.28, metalness: 1 }),
    steel: new MeshStandardMaterial({ name: 'steel', color: 0xb9bec4, roughness: 0.25, metalness: 1 }),
    enamel: new MeshStandardMaterial({ name: 'enamel', color: 0xf4efe4, roughness: 0.22, emissive: 0x6a655c, emissiveIntensity: 0.45 }),
    tongue: new MeshStandardMaterial({ name: 'tongue', color: 0xa8484c, roughness: 0.36, emissive: 0x3a1214, emissiveIntensity: 0.35 }),
    eye: new MeshStandardMaterial({ name: 'eye', vertexColors: true, roughness: 0.3 }),
    cornea: new MeshStandardMaterial({ name: 'cornea', color: 0x000000, roughness: 0.03, transparent: true, blending: AdditiveBlending, depthWrite: false }),
  };
}

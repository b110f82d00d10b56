import {
  ACESFilmicToneMapping, BackSide, BoxGeometry, Color, DirectionalLight, HemisphereLight, Mesh, MeshBasicMaterial, PCFShadowMap,
  PMREMGenerator, PerspectiveCamera, Scene, SphereGeometry, WebGLRenderer,
} from 'three';

import { TOP } from './surface.js';

// What the camera sees at rest, in cm around its middle: so much of height at least, and of width; and where the head ends.
const MIDDLE_Y = -2.6, DISTANCE = 78, TALL = 33.2, WIDE = 27.2, CROWN = TOP - MIDDLE_Y;
const fieldOf = (height) => (360 / Math.PI) * Math.atan(height / 2 / DISTANCE);

// Three-point light: a warm key from the character's right and above, a cool fill from its left, a rim from behind; and
// a studio of soft boxes that metal and eyes mirror.
export class Studio {
  scene = new Scene();
  camera = new PerspectiveCamera(fieldOf(TALL), 1, 5, 400);

  constructor(canvas) {
    this.renderer = new WebGLRenderer({ canvas, antialias: true, alpha: true, preserveDrawingBuffer: true });
    this.renderer.toneMapping = ACESFilmicToneMapping;
    this.renderer.toneMappingExposure = 1.04;
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.type = PCFShadowMap;
    this.#addLights();
    this.scene.environment = this.#softBoxes();
    this.scene.environmentIntensity = 0.55;
    this.look(0, 0);
  }

  // The camera's place: degrees around and above the face; `distance` in cm.
  look(azimuth, elevation, distance = DISTANCE) {
    const a = (azimuth * Math.PI) / 180, e = (elevation * Math.PI) / 180;
    this.camera.position.set(distance * Math.sin(a) * Math.cos(e), MIDDLE_Y + distance * Math.sin(e), distance * Math.cos(a) * Math.cos(e));
    this.camera.lookAt(0, MIDDLE_Y, 0);
  }

  // A head at rest keeps below the uppermost `header` pixels, which the picture fills, too.
  resize(width, height, ratio, header = 0) {
    this.renderer.setPixelRatio(ratio);
    this.renderer.setSize(width, height, false);
    const tall = (header - (0.5 - CROWN / TALL) * height) / (0.5 + CROWN / TALL); // what has to be added above, where height is scarce
    const wide = 2 * (header + (CROWN / WIDE) * width) - height; // ... where width is
    const above = Math.max(0, Math.min(tall, wide)), below = height - above;
    // A narrow window sees the whole head, too.
    this.camera.fov = fieldOf(Math.max(TALL, (WIDE * below) / width));
    this.camera.setViewOffset(width, below, 0, -above, width, height);
  }

  render() { this.renderer.render(this.scene, this.camera); }

  #addLights() {
    const light = (color, intensity, x, y, z) => {
      const l = new DirectionalLight(color, intensity);
      l.position.set(x, y, z);
      this.scene.add(l);
      return l;
    };
    const key = light(0xfff0de, 2.3, -26, 30, 40);
    key.castShadow = true;
    key.shadow.mapSize.set(1024, 1024);
    Object.assign(key.shadow.camera, { left: -15, right: 15, top: 16, bottom: -24, near: 10, far: 110 });
    key.shadow.bias = -0.0006;
    key.shadow.normalBias = 0.2;
    key.shadow.radius = 5;
    light(0xcfe0ff, 0.8, 36, 4, 30);
    light(0xdfeaff, 2.2, 24, 22, -34);
    light(0xffc9a0, 1.1, -30, 6, -30);
    // What the bust throws back from below, so that nose and chin do not end in black.
    this.scene.add(new HemisphereLight(0xdfe6f0, 0xe8c9b0, 0.42));
  }

  #softBoxes() {
    const room = new Scene();
    const box = (color, strength, size, at) => {
      const mesh = new Mesh(new BoxGeometry(...size), new MeshBasicMaterial({ color: new Color(color).multiplyScalar(strength) }));
      mesh.position.set(...at);
      room.add(mesh);
    };
    room.add(new Mesh(new SphereGeometry(50, 32, 16), new MeshBasicMaterial({ color: 0x4a5058, side: BackSide })));
    box(0xfff1e0, 9, [14, 14, 0.5], [-20, 18, 24]);
    box(0xdbe8ff, 4, [8, 20, 0.5], [28, 6, 18]);
    box(0xffffff, 5, [30, 0.5, 10], [0, 34, -4]);
    box(0xcfdcff, 5, [3, 24, 3], [24, 6, -26]);
    const generator = new PMREMGenerator(this.renderer);
    const { texture } = generator.fromScene(room, 0.03);
    generator.dispose();
    return texture;
  }
}

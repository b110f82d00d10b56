import { loadCharacter } from '../character/load.js';
import { ARKIT } from '../character/names.js';
import { takeFiles } from './drop.js';

// Who is on the stage: Otto or a character of the visitor's, what of it moves, and what does not.

const $ = (id) => document.getElementById(id);
const put = (id, text) => { $(id).textContent = text; };
function list(id, items) {
  $(id).replaceChildren(...items.map((textContent) => Object.assign(document.createElement('li'), { textContent })));
  $(`${id}-part`).hidden = items.length === 0;
}

export class Cast {
  #show;
  #latest = 0; // of several that are loading, the last one counts

  // show(character) puts one on the stage; `otto` is the one to come back to.
  constructor(otto, show) {
    this.#show = show;
    takeFiles($('character-open'), $('character-files'), (files) => this.#take(files));
    $('character-otto').onclick = () => {
      ++this.#latest;
      this.#complain('');
      put('character-answer', '');
      show(otto);
      $('character-open').focus(); // the button that had it is gone
    };
    $('character-close').onclick = () => this.#complain('');
    document.addEventListener('keydown', ({ key }) => { if (key === 'Escape') this.#complain(''); });
  }

  // What is known of the character that is shown; `driver` is null while there is no rig.
  tell(character, driver) {
    const shapes = new Set(character.shapeNames);
    const bones = character.aliases ? [...character.aliases].map(([name, part]) => (name === part ? part : `${part}: ${name}`)) : [...character.bones.keys()];
    put('character-name', character.name);
    $('character-name').title = character.name;
    put('character-shapes', `${ARKIT.filter((name) => shapes.has(name)).length} of ${ARKIT.length}`);
    put('character-bones', String(bones.length));
    $('character-otto').hidden = !character.dispose;
    $('view').setAttribute('aria-label', `${character.name}, moving with the performer's face. Arrow keys turn the view.`);
    list('character-bone-list', bones);
    list('character-left', character.leftToShapes ?? []);
    list('gap-arkit', ARKIT.filter((name) => !shapes.has(name)));
    list('gap-values', driver?.unused ?? []);
    list('gap-shapes', driver ? character.unmovedBy(driver.moved) : []);
    list('gap-still', character.still ?? []);
  }

  async #take(files) {
    const turn = ++this.#latest;
    this.#complain('');
    put('character-answer', `Loading ${files.find(({ name }) => /\.(glb|gltf|vrm)$/i.test(name))?.name ?? 'it'} …`);
    try {
      const character = await loadCharacter(files);
      if (turn !== this.#latest) character.dispose();
      else this.#show(character);
    } catch (error) {
      if (turn === this.#latest) this.#complain(`${error.message}.`);
    }
    if (turn === this.#latest) put('character-answer', '');
  }

  #complain(text) {
    $('character-notice').hidden = !text;
    put('character-problem', text);
  }
}

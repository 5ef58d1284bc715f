// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Colour theme: light, dark, or the system setting.

const themes = ['auto', 'light', 'dark'];
const place = 'tofsmith-lab-theme';

function kept() {
  try {
    return localStorage.getItem(place);
  } catch {  // local files may have no storage
    return null;
  }
}

/** Makes a button cycle through the themes. Starts with the theme that was last selected. */
export function startTheme(button) {
  const show = (theme) => {
    if (theme === 'auto')
      delete document.documentElement.dataset.theme;
    else
      document.documentElement.dataset.theme = theme;
    button.textContent = `\u25d0 ${theme[0].toUpperCase()}${theme.slice(1)}`;
    button.setAttribute('aria-label', `Colours: ${theme}; change`);
    button.dataset.now = theme;
    dispatchEvent(new Event('themechange'));
  };
  show(themes.includes(kept()) ? kept() : 'auto');
  button.addEventListener('click', () => {
    const next = themes[(themes.indexOf(button.dataset.now) + 1) % themes.length];
    try {
      localStorage.setItem(place, next);
    } catch {
      // without storage, the selection is lost when the page is closed
    }
    show(next);
  });
}

"""Joins pictures (panels) into one picture with rows of COLUMNS panels: compose.py OUT.png COLUMNS PANEL.png ..."""

import math
import sys

from PIL import Image, ImageDraw, ImageFont

GAP = 4
GAP_COLOUR = (58, 68, 86)
LETTER_COLOUR = (230, 236, 245)
FONT = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf"


def compose_panels(panels, columns):
    """Returns one picture of all panels, row by row, with `columns` panels in each row.

    All panels must have the size of the first. Each panel gets a letter, (a), (b), ..., in its upper right corner.
    """
    width, height = panels[0].size
    rows = math.ceil(len(panels) / columns)
    size = (columns * (width + GAP) - GAP, rows * (height + GAP) - GAP)
    whole = Image.new("RGB", size, GAP_COLOUR)
    draw = ImageDraw.Draw(whole)
    font = ImageFont.truetype(FONT, height // 20)
    for i in range(rows * columns):
        x, y = i % columns * (width + GAP), i // columns * (height + GAP)
        if i >= len(panels):
            whole.paste(panels[0].getpixel((width - 1, height - 1)), (x, y, x + width, y + height))
            continue
        whole.paste(panels[i], (x, y))
        corner = (x + width - height // 25, y + height // 25)
        draw.text(corner, f"({chr(ord('a') + i)})", fill=LETTER_COLOUR, font=font, anchor="ra")
    return whole


def main():
    if len(sys.argv) < 4:
        sys.exit(__doc__)
    out, columns, *files = sys.argv[1:]
    compose_panels([Image.open(file) for file in files], int(columns)).save(out, optimize=True)


if __name__ == "__main__":
    main()

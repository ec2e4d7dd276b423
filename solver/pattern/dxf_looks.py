"""What a DXF file says about an entity beside its shape: layer, colour and line type, its own or its block's."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from ..dxf_library import dxf_library
from .meaning import Evidence
from .svg_values import Colour

#: Colour numbers that mean the block's colour, the layer's colour, and black or white, whichever is seen.
_BY_BLOCK, _BY_LAYER, _FOREGROUND = 0, 256, 7
_BLACK = Colour(0.0, 0.0, 0.0)
#: Lighter greys are drawn on a black screen, where white is what black is on paper.
_WHITE = 0.95
#: The layer on which a block's entities lie on the layer of the block's reference.
_NEUTRAL = "0"


@dataclass(frozen=True)
class Look:
    """What an entity takes over from the reference to its block, and what the outermost ones look like.

    words  of blocks and layers around, for ``meaning.Evidence``
    """

    layer: str = _NEUTRAL
    colour: Colour = _BLACK
    linetype: str = "Continuous"
    words: tuple[tuple[str, str], ...] = ()

    @property
    def evidence_words(self) -> tuple[tuple[str, str], ...]:
        return (("linetype", self.linetype), ("layer", self.layer), *self.words)


@dataclass(frozen=True)
class _Layer:
    colour: Colour
    linetype: str
    off: bool
    frozen: bool


class Looks:
    """The layers and line types of a document."""

    def __init__(self, document: Any) -> None:
        self._layers = {
            layer.dxf.name.casefold(): _Layer(
                _colour(layer.dxf.get("color", _FOREGROUND), layer.dxf.get("true_color")) or _BLACK,
                str(layer.dxf.get("linetype", "Continuous")),
                layer.is_off(),
                layer.is_frozen(),
            )
            for layer in document.layers
        }
        self._dashes = {linetype.dxf.name.casefold(): _dashes(linetype) for linetype in document.linetypes}

    def off(self, look: Look) -> bool:
        """Whether its layer hides lines, but not what else is in its blocks."""
        layer = self._layers.get(look.layer.casefold())
        return layer is not None and layer.off

    def frozen(self, look: Look) -> bool:
        """Whether its layer hides what is in its blocks too, on whatever layers that is."""
        layer = self._layers.get(look.layer.casefold())
        return layer is not None and layer.frozen

    def of(self, entity: Any, around: Look) -> Look:
        """How an entity in a block looks whose reference looks like ``around``."""
        name = str(entity.dxf.get("layer", _NEUTRAL))
        if name == _NEUTRAL:
            name = around.layer
        layer = self._layers.get(name.casefold(), _Layer(_BLACK, "Continuous", False, False))
        number = int(entity.dxf.get("color", _BY_LAYER))
        own = _colour(number, entity.dxf.get("true_color"))
        colour = own if own is not None else around.colour if number == _BY_BLOCK else layer.colour
        linetype = str(entity.dxf.get("linetype", "BYLAYER"))
        by = {"bylayer": layer.linetype, "byblock": around.linetype}
        return Look(name, colour, by.get(linetype.casefold(), linetype), around.words)

    def evidence(self, look: Look) -> Evidence:
        return Evidence(look.colour, self._dashes.get(look.linetype.casefold(), ()), look.evidence_words)


def _colour(number: int, true_colour: int | None) -> Colour | None:
    """None where the number says whose colour it is."""
    colours = dxf_library().colors
    if true_colour is not None:
        red, green, blue = colours.int2rgb(true_colour)
    elif number in (_BY_BLOCK, _BY_LAYER):
        return None
    elif not 0 < abs(number) < _BY_LAYER:
        return _BLACK
    else:
        red, green, blue = colours.aci2rgb(abs(number))
    found = Colour(red / 255.0, green / 255.0, blue / 255.0)
    return _BLACK if found.chroma == 0.0 and found.lightness > _WHITE else found


def _dashes(linetype: Any) -> tuple[float, ...]:
    """Dash and gap lengths; dots have none. Empty for a line without gaps."""
    lengths = [float(tag.value) for tag in linetype.pattern_tags.tags if tag.code == 49]
    gaps = [-length for length in lengths if length < 0.0]
    if not gaps:
        return ()
    return tuple(value for length in lengths if length >= 0.0 for value in (length, gaps[0]))

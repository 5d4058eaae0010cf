"""Makes masks of the Shapes in a Picture from its channels id and cryptomatte."""
from . import _arguments


def _runs(mask):
    """Returns the lengths of the runs of a mask, column by column: first that of the pixels outside
    (perhaps 0), then inside, outside and so on."""
    import numpy as np
    flat = mask.ravel(order="F")
    edges = np.flatnonzero(flat[1:] != flat[:-1]) + 1
    counts = np.diff(np.concatenate(([0], edges, [flat.size]))).tolist()
    return [0, *counts] if flat[0] else counts


def _packed(counts):
    """Returns the text that pycocotools makes of runs: six bits a character, differences to the run
    before the last one."""
    text = []
    for i, value in enumerate(counts):
        rest = value - (counts[i - 2] if i > 2 else 0)
        while True:
            bits, rest = rest & 31, rest >> 5
            more = rest != (-1 if bits & 16 else 0)
            text.append(chr((bits | (32 if more else 0)) + 48))
            if not more:
                break
    return "".join(text)


def _category(categories, name):
    if categories is None:
        return name
    found = categories(name) if callable(categories) else categories.get(name)
    if found is not None and not isinstance(found, str):
        raise TypeError(f"categories: a text or None expected for {name!r}, not {found!r}")
    return found


def _numbers(picture, names):
    """Returns the numbers that stand for these names in the channel cryptomatte."""
    if not picture.names:  # a picture of a Context, whose names are numbers
        return {_arguments.whole("matte: a name of a Context", name, 1, 0xffffffff) for name in names}
    numbers = set()
    for name in names:
        if not isinstance(name, str):
            raise TypeError(f"matte: the name of a Shape expected, not {name!r}")
        found = [i for i, one in enumerate(picture.names) if one and one == name]
        if not found:
            known = sorted(set(picture.names) - {""})
            shown = ", ".join(known[:20]) + (" ..." if len(known) > 20 else "")
            raise KeyError(f"no Shape has the name {name!r}; " +
                           (f"names are {shown}" if known else "there is none"))
        numbers.update(found)
    return numbers


def matte(picture, *names):
    """Implements Picture.matte()."""
    import numpy as np
    if "cryptomatte" not in picture.channels:
        raise AttributeError("the picture has no channel cryptomatte: "
                             "render(channels=('cryptomatte',)) makes it")
    wanted = np.array(sorted(_numbers(picture, names)), np.float32)
    pairs = picture["cryptomatte"]
    numbers, shares = pairs[..., 0::2], pairs[..., 1::2]
    return np.where(np.isin(numbers, wanted), shares, 0).sum(axis=-1, dtype=np.float32)


def coco(picture, image_id=1, file_name="", categories=None, compressed=False, first_id=1):
    """Implements Picture.coco()."""
    import numpy as np
    image_id = _arguments.whole("image_id", image_id, 0)
    number = _arguments.whole("first_id", first_id, 0)
    if not isinstance(file_name, str):
        raise TypeError(f"file_name: a text expected, not {file_name!r}")
    if categories is not None and not callable(categories) and not hasattr(categories, "get"):
        raise TypeError("categories: a dict from names to categories, a function or None expected")
    if "id" not in picture.channels:
        raise AttributeError("the picture has no channel id: render(channels=('id',)) makes it")
    ids = picture["id"]
    height, width = ids.shape
    seen = [i for i in np.unique(ids).tolist() if i]
    # A number without a name belongs to no Shape. In pictures of a Context, names are the numbers.
    names = dict(enumerate(picture.names)) if picture.names else {i: str(i) for i in seen}
    kinds = {i: _category(categories, name) for i, name in names.items() if name}
    # A dict numbers its categories alike in all pictures, whatever they show.
    listed = categories.values() if hasattr(categories, "values") else kinds.values()
    numbers = {}
    for kind in listed:
        if kind is not None:
            numbers.setdefault(kind, len(numbers) + 1)
    annotations = []
    for i in seen:
        if kinds.get(i) is None:
            continue
        mask = ids == i
        rows, columns = np.flatnonzero(mask.any(1)), np.flatnonzero(mask.any(0))
        x, y = int(columns[0]), int(rows[0])
        counts = _runs(mask)
        annotations.append({
            "id": number,
            "image_id": image_id,
            "category_id": numbers[kinds[i]],
            "bbox": [x, y, int(columns[-1]) - x + 1,
                     int(rows[-1]) - y + 1],
            "area": int(mask.sum()),
            "segmentation": {
                "size": [height, width],
                "counts": _packed(counts) if compressed else counts
            },
            "iscrowd": 0,
        })
        number += 1
    return {
        "images": [{
            "id": image_id,
            "width": width,
            "height": height,
            "file_name": file_name
        }],
        "categories": [{
            "id": n,
            "name": kind
        } for kind, n in numbers.items()],
        "annotations": annotations,
    }

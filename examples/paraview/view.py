"""Shows a result of `luxel solve` in ParaView as it looks: unlit, in true colours or as a map of luminance.

    pvpython view.py room.vtp                  the luminance map, in a window
    pvpython view.py --colours room.vtp        display_rgb, tone-mapped by Luxel, smooth between the vertices
    pvpython view.py --shot room.png room.pvd  a picture of the last step, then exit

In the ParaView program: Tools > Python Shell > Run Script (it shows the source that is active).
"""
import argparse
import sys

from paraview import simple


def unlit(display):
    """Shows colours as they are: radiosity is light already, ParaView's lamps must not be added to it."""
    display.Ambient, display.Diffuse, display.Specular = 1.0, 0.0, 0.0
    display.Interpolation = "Flat"
    display.BackfaceRepresentation = "Cull Backface"  # from outside one sees into the room


def show_colours(display):
    simple.ColorBy(display, ("POINTS", "display_rgb"))
    display.MapScalars = 0  # the bytes are the colours


def show_luminance(display, source, view, decades):
    simple.ColorBy(display, ("CELLS", "luminance"))
    highest = max(source.CellData.GetArray("luminance").GetRange()[1], 1e-30)
    colours = simple.GetColorTransferFunction("luminance")
    colours.ApplyPreset("Inferno (matplotlib)", True)
    colours.RescaleTransferFunction(highest * 10.0 ** -decades, highest)
    colours.MapControlPointsToLogSpace()
    colours.UseLogScale = 1
    bar = simple.GetScalarBar(colours, view)
    bar.Title, bar.ComponentTitle = "luminance, W/(m2 sr)", ""
    bar.TitleColor = bar.LabelColor = [0.0, 0.0, 0.0]
    bar.TitleFontSize, bar.LabelFontSize = 16, 14
    bar.WindowLocation, bar.Position, bar.ScalarBarLength = "Any Location", [0.9, 0.25], 0.5
    bar.AddRangeLabels = 0
    display.SetScalarBarVisibility(view, True)


def place_camera(view, source):
    """From where `luxel render` takes its picture: the field data say it, one tuple each."""
    def values(name):
        array = source.FieldData.GetArray(name)
        return [array.GetRange(k)[0] for k in range(array.GetNumberOfComponents())]

    view.CameraPosition, view.CameraFocalPoint = values("view_eye"), values("view_target")
    view.CameraViewUp, view.CameraViewAngle = values("view_up"), values("view_fov")[0]
    view.CenterOfRotation = view.CameraFocalPoint


def show(source, colours, decades):
    view = simple.GetActiveViewOrCreate("RenderView")
    view.ViewSize = [1200, 900]
    view.OrientationAxesVisibility = 0
    view.UseColorPaletteForBackground = 0
    view.BackgroundColorMode = "Single Color"
    view.Background = [1.0, 1.0, 1.0]
    display = simple.Show(source, view)
    source.UpdatePipeline()
    times = getattr(source, "TimestepValues", None)
    if times:
        view.ViewTime = times[-1] if hasattr(times, "__len__") else times
        source.UpdatePipeline(view.ViewTime)
    unlit(display)
    if colours:
        show_colours(display)
    else:
        show_luminance(display, source, view, decades)
    simple.Render(view)  # the first rendering moves the camera
    place_camera(view, source)
    simple.Render(view)
    return view


def main(arguments):
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("file", help="a .vtp, .vtu or .pvd that Luxel wrote")
    parser.add_argument("--colours", action="store_true", help="show display_rgb instead of the luminance map")
    parser.add_argument("--decades", type=float, default=3.0, help="what the luminance map spans (3)")
    parser.add_argument("--shot", metavar="PNG", help="write a picture and exit")
    options = parser.parse_args(arguments)
    view = show(simple.OpenDataFile(options.file), options.colours, options.decades)
    if options.shot:
        simple.SaveScreenshot(options.shot, view)
    else:
        simple.Interact(view)


if len(sys.argv) > 1:
    main(sys.argv[1:])
elif simple.GetActiveSource():
    show(simple.GetActiveSource(), colours=False, decades=3.0)
else:
    sys.exit("view.py: name a file, or open one first")

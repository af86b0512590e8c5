// What is known to fail, by cause. tools/state_departures.py prints the rows of a report; causes are written by hand.
#include <weft/validation/departures/stated_departures.hpp>

namespace weft::validation {
namespace {

const StatedDeparture kBending{
    "bullet_weft",
    "Bending acts as a force of the start of the step and is held stable by a constant matrix: "
    "where D h^2 / (rho dx^4) is large that matrix carries the strip, so that it neither reaches "
    "its equilibrium nor swings in time",
    {
        {"cantilever", "bullet_weft float32, 1/120 s",
         "in the engine: a heavy strip, Gamma = 1, 20 cells, hangs as the elastica",
         "relative error of H / W, Gamma = 1, N = 20", 0.0878},
        {"cantilever", "bullet_weft float32, 1/30 s",
         "in the engine: a heavy strip, Gamma = 1, 20 cells, hangs as the elastica",
         "relative error of H / W, Gamma = 1, N = 20", 0.716},
        {"cantilever", "bullet_weft float32, 1/60 s",
         "in the engine: a heavy strip, Gamma = 1, 20 cells, hangs as the elastica",
         "relative error of H / W, Gamma = 1, N = 20", 0.547},
        {"cantilever", "bullet_weft float64, 1/30 s",
         "in the engine: a heavy strip, Gamma = 1, 20 cells, hangs as the elastica",
         "relative error of H / W, Gamma = 1, N = 20", 0.679},
        {"cantilever", "bullet_weft float64, 1/60 s",
         "in the engine: a heavy strip, Gamma = 1, 20 cells, hangs as the elastica",
         "relative error of H / W, Gamma = 1, N = 20", 0.327},
        {"fabrics", "bullet_weft float32, 1/120 s",
         "in the engine: a strip of 300 g/m^2, 0.3 mN m, cells of 5 mm, hangs as the elastica",
         "relative error of H / W, Gamma = 264.9, N = 60", 0.713},
        {"fabrics", "bullet_weft float32, 1/120 s",
         "in the engine: a strip of paper of 80 g/m^2, 0.3 mN m, cells of 5 mm, hangs as the "
         "elastica",
         "relative error of H / W, Gamma = 20.93, N = 40", 0.307},
        {"fabrics", "bullet_weft float32, 1/240 s",
         "in the engine: a strip of paper of 80 g/m^2, 0.3 mN m, cells of 5 mm, hangs as the "
         "elastica",
         "relative error of H / W, Gamma = 20.93, N = 40", 0.378},
        {"fabrics", "bullet_weft float32, 1/30 s",
         "in the engine: a strip of 300 g/m^2, 0.3 mN m, cells of 5 mm, hangs as the elastica",
         "relative error of H / W, Gamma = 264.9, N = 60", 0.978},
        {"fabrics", "bullet_weft float32, 1/30 s",
         "in the engine: a strip of cotton of 150 g/m^2, 2.34 uN m, cells of 2.5 mm, hangs as the "
         "elastica",
         "relative error of H / W, Gamma = 628.8, N = 40", 0.519},
        {"fabrics", "bullet_weft float32, 1/30 s",
         "in the engine: a strip of denim of 400 g/m^2, 0.1 mN m, cells of 5 mm, hangs as the "
         "elastica",
         "relative error of H / W, Gamma = 313.9, N = 40", 0.825},
        {"fabrics", "bullet_weft float32, 1/30 s",
         "in the engine: a strip of leather of 900 g/m^2, 2 mN m, cells of 1 cm, hangs as the "
         "elastica",
         "relative error of H / W, Gamma = 119.2, N = 30", 0.0374},
        {"fabrics", "bullet_weft float32, 1/30 s",
         "in the engine: a strip of paper of 80 g/m^2, 0.3 mN m, cells of 5 mm, hangs as the "
         "elastica",
         "relative error of H / W, Gamma = 20.93, N = 40", 0.541},
        {"fabrics", "bullet_weft float32, 1/60 s",
         "in the engine: a strip of 300 g/m^2, 0.3 mN m, cells of 5 mm, hangs as the elastica",
         "relative error of H / W, Gamma = 264.9, N = 60", 0.927},
        {"fabrics", "bullet_weft float32, 1/60 s",
         "in the engine: a strip of cotton of 150 g/m^2, 2.34 uN m, cells of 2.5 mm, hangs as the "
         "elastica",
         "relative error of H / W, Gamma = 628.8, N = 40", 0.591},
        {"fabrics", "bullet_weft float32, 1/60 s",
         "in the engine: a strip of denim of 400 g/m^2, 0.1 mN m, cells of 5 mm, hangs as the "
         "elastica",
         "relative error of H / W, Gamma = 313.9, N = 40", 0.479},
        {"fabrics", "bullet_weft float32, 1/60 s",
         "in the engine: a strip of paper of 80 g/m^2, 0.3 mN m, cells of 5 mm, hangs as the "
         "elastica",
         "relative error of H / W, Gamma = 20.93, N = 40", 0.426},
        {"fabrics", "bullet_weft float64, 1/120 s",
         "in the engine: a strip of 300 g/m^2, 0.3 mN m, cells of 5 mm, hangs as the elastica",
         "relative error of H / W, Gamma = 264.9, N = 60", 0.726},
        {"fabrics", "bullet_weft float64, 1/30 s",
         "in the engine: a strip of 300 g/m^2, 0.3 mN m, cells of 5 mm, hangs as the elastica",
         "relative error of H / W, Gamma = 264.9, N = 60", 0.948},
        {"fabrics", "bullet_weft float64, 1/60 s",
         "in the engine: a strip of 300 g/m^2, 0.3 mN m, cells of 5 mm, hangs as the elastica",
         "relative error of H / W, Gamma = 264.9, N = 60", 0.967},
        {"frequencies", "bullet_weft float32, 1/120 s",
         "in the engine: a clamped strip of 32 cells in its first mode has its frequency",
         "relative error of its frequency", 0.0497},
        {"frequencies", "bullet_weft float32, 1/120 s",
         "in the engine: a clamped strip of 32 cells in its first mode keeps its energy",
         "relative error of the energy left after one period", 0.161},
        {"frequencies", "bullet_weft float32, 1/30 s",
         "in the engine: a clamped strip of 32 cells in its first mode has its frequency",
         "relative error of its frequency", 0.857},
        {"frequencies", "bullet_weft float32, 1/60 s",
         "in the engine: a clamped strip of 32 cells in its first mode has its frequency",
         "relative error of its frequency", 0.489},
        {"frequencies", "bullet_weft float32, 1/60 s",
         "in the engine: a clamped strip of 32 cells in its first mode keeps its energy",
         "relative error of the energy left after one period", 0.12},
        {"frequencies", "bullet_weft float64, 1/120 s",
         "in the engine: a clamped strip of 32 cells in its first mode has its frequency",
         "relative error of its frequency", 0.0445},
        {"frequencies", "bullet_weft float64, 1/240 s",
         "in the engine: a clamped strip of 32 cells in its first mode has its frequency",
         "relative error of its frequency", 0.0163},
        {"frequencies", "bullet_weft float64, 1/30 s",
         "in the engine: a clamped strip of 32 cells in its first mode has its frequency",
         "relative error of its frequency", 0.555},
        {"frequencies", "bullet_weft float64, 1/30 s",
         "in the engine: a clamped strip of 32 cells in its first mode keeps its energy",
         "relative error of the energy left after one period", 0.405},
        {"frequencies", "bullet_weft float64, 1/60 s",
         "in the engine: a clamped strip of 32 cells in its first mode has its frequency",
         "relative error of its frequency", 0.228},
        {"frequencies", "bullet_weft float64, 1/60 s",
         "in the engine: a clamped strip of 32 cells in its first mode keeps its energy",
         "relative error of the energy left after one period", 0.464},
    }};

const StatedDeparture kLedNodes{
    "bullet_weft",
    "A body with led nodes is stepped by implicit Euler, even while they stand still: a swing "
    "loses about 2 pi w h of its energy in a period",
    {
        {"frequencies", "bullet_weft float32, 1/120 s",
         "in the engine: a membrane of 12 x 12 cells in its first mode keeps its energy",
         "relative error of the energy left after one period", 0.404},
        {"frequencies", "bullet_weft float32, 1/120 s",
         "in the engine: a string of 20 masses in its first mode keeps its energy",
         "relative error of the energy left after one period", 0.198},
        {"frequencies", "bullet_weft float32, 1/240 s",
         "in the engine: a membrane of 12 x 12 cells in its first mode keeps its energy",
         "relative error of the energy left after one period", 0.228},
        {"frequencies", "bullet_weft float32, 1/240 s",
         "in the engine: a string of 20 masses in its first mode keeps its energy",
         "relative error of the energy left after one period", 0.105},
        {"frequencies", "bullet_weft float32, 1/30 s",
         "in the engine: a membrane of 12 x 12 cells in its first mode has its frequency",
         "relative error of its frequency", 0.422},
        {"frequencies", "bullet_weft float32, 1/30 s",
         "in the engine: a membrane of 12 x 12 cells in its first mode keeps its energy",
         "relative error of the energy left after one period", 0.881},
        {"frequencies", "bullet_weft float32, 1/30 s",
         "in the engine: a string of 20 masses in its first mode keeps its energy",
         "relative error of the energy left after one period", 0.585},
        {"frequencies", "bullet_weft float32, 1/60 s",
         "in the engine: a membrane of 12 x 12 cells in its first mode keeps its energy",
         "relative error of the energy left after one period", 0.657},
        {"frequencies", "bullet_weft float32, 1/60 s",
         "in the engine: a string of 20 masses in its first mode keeps its energy",
         "relative error of the energy left after one period", 0.357},
        {"frequencies", "bullet_weft float64, 1/120 s",
         "in the engine: a membrane of 12 x 12 cells in its first mode keeps its energy",
         "relative error of the energy left after one period", 0.404},
        {"frequencies", "bullet_weft float64, 1/120 s",
         "in the engine: a string of 20 masses in its first mode keeps its energy",
         "relative error of the energy left after one period", 0.198},
        {"frequencies", "bullet_weft float64, 1/240 s",
         "in the engine: a membrane of 12 x 12 cells in its first mode keeps its energy",
         "relative error of the energy left after one period", 0.228},
        {"frequencies", "bullet_weft float64, 1/240 s",
         "in the engine: a string of 20 masses in its first mode keeps its energy",
         "relative error of the energy left after one period", 0.105},
        {"frequencies", "bullet_weft float64, 1/30 s",
         "in the engine: a membrane of 12 x 12 cells in its first mode keeps its energy",
         "relative error of the energy left after one period", 0.86},
        {"frequencies", "bullet_weft float64, 1/30 s",
         "in the engine: a string of 20 masses in its first mode keeps its energy",
         "relative error of the energy left after one period", 0.584},
        {"frequencies", "bullet_weft float64, 1/60 s",
         "in the engine: a membrane of 12 x 12 cells in its first mode keeps its energy",
         "relative error of the energy left after one period", 0.641},
        {"frequencies", "bullet_weft float64, 1/60 s",
         "in the engine: a string of 20 masses in its first mode keeps its energy",
         "relative error of the energy left after one period", 0.357},
    }};

const StatedDeparture kTurningSprings{
    "bullet_weft",
    "Two linearisations do not end the solution of a stiff spring that turns far in a step: period "
    "and energy are off by 1.5 to 4 times what a second-order method leaves",
    {
        {"spring_pendulum", "bullet_weft float32, 1/30 s",
         "in the engine: a stiff pendulum, amplitude 120 degrees, has its period",
         "relative error of its period", 0.0548},
        {"spring_pendulum", "bullet_weft float32, 1/30 s",
         "in the engine: a stiff pendulum, amplitude 120 degrees, keeps its energy",
         "relative error of the energy left after one period, from 5 of them", 0.0421},
        {"spring_pendulum", "bullet_weft float32, 1/30 s",
         "in the engine: a stiff pendulum, amplitude 60 degrees, keeps its energy",
         "relative error of the energy left after one period, from 5 of them", 0.0153},
        {"spring_pendulum", "bullet_weft float32, 1/60 s",
         "in the engine: a stiff pendulum, amplitude 120 degrees, has its period",
         "relative error of its period", 0.00917},
        {"spring_pendulum", "bullet_weft float32, 1/60 s",
         "in the engine: a stiff pendulum, amplitude 120 degrees, keeps its energy",
         "relative error of the energy left after one period, from 5 of them", 0.00729},
        {"spring_pendulum", "bullet_weft float64, 1/30 s",
         "in the engine: a stiff pendulum, amplitude 120 degrees, has its period",
         "relative error of its period", 0.0548},
        {"spring_pendulum", "bullet_weft float64, 1/30 s",
         "in the engine: a stiff pendulum, amplitude 120 degrees, keeps its energy",
         "relative error of the energy left after one period, from 5 of them", 0.0421},
        {"spring_pendulum", "bullet_weft float64, 1/30 s",
         "in the engine: a stiff pendulum, amplitude 60 degrees, keeps its energy",
         "relative error of the energy left after one period, from 5 of them", 0.0153},
        {"spring_pendulum", "bullet_weft float64, 1/60 s",
         "in the engine: a stiff pendulum, amplitude 120 degrees, has its period",
         "relative error of its period", 0.00918},
        {"spring_pendulum", "bullet_weft float64, 1/60 s",
         "in the engine: a stiff pendulum, amplitude 120 degrees, keeps its energy",
         "relative error of the energy left after one period, from 5 of them", 0.00729},
    }};

const StatedDeparture kSliding{
    "bullet_weft",
    "While something touches the cloth the step is implicit Euler and friction follows the holding "
    "force of the round before: in long steps a cloth slides too far",
    {
        {"incline", "bullet_weft float32, 1/30 s",
         "in the engine: a cloth slides down 10 degrees, mu = 0.1",
         "relative error of its way in 0.5 s", 0.992},
        {"incline", "bullet_weft float64, 1/30 s",
         "in the engine: a cloth slides down 10 degrees, mu = 0.1",
         "relative error of its way in 0.5 s", 0.988},
        {"sliding_cloth", "bullet_weft float32, 1/30 s",
         "in the engine: a cloth thrown along the ground at 2 m/s stops",
         "relative error of its way, at 1.5 s", 0.207},
        {"sliding_cloth", "bullet_weft float64, 1/30 s",
         "in the engine: a cloth thrown along the ground at 2 m/s stops",
         "relative error of its way, at 1.5 s", 0.278},
    }};

const StatedDeparture kDampedContact{
    "bullet_weft",
    "While something touches the cloth the step is implicit Euler, which damps what changes within "
    "a step of 1/100 s",
    {
        {"ball_on_cloth", "bullet_weft float32", "stays near the reference",
         "RMS node distance / cloth size, 0 to 0.5 s", 0.0303},
        {"ball_on_cloth", "bullet_weft float64", "stays near the reference",
         "RMS node distance / cloth size, 0 to 0.5 s", 0.0304},
        {"drop_ground", "bullet_weft float32", "stays near the reference",
         "RMS node distance / cloth size, 0 to 0.5 s", 0.171},
        {"drop_ground", "bullet_weft float64", "stays near the reference",
         "RMS node distance / cloth size, 0 to 0.5 s", 0.174},
    }};

const StatedDeparture kSinglePrecision{
    "bullet_forces",
    "In single precision a node cannot move by less than the rounding of its place in a step: a "
    "chain that comes to rest, and a slow swing, stall",
    {
        {"hanging_chain", "bullet_forces float32",
         "in the engine: a chain of 10 masses hangs as theory says",
         "relative error of the tip's drop", 0.00267},
        {"hanging_chain", "bullet_forces float32",
         "in the engine: a chain of 30 masses hangs as theory says",
         "relative error of the tip's drop", 0.00777},
        {"spring_pendulum", "bullet_forces float32",
         "in the engine: a stiff pendulum, amplitude 60 degrees, keeps its energy",
         "relative error of the energy left after one period, from 5 of them", 0.0024},
    }};

}  // namespace

std::span<const StatedDeparture> stated_departures() {
  static const std::vector<StatedDeparture> kTable = {kBending, kLedNodes,      kTurningSprings,
                                                      kSliding, kDampedContact, kSinglePrecision};
  return kTable;
}

}  // namespace weft::validation

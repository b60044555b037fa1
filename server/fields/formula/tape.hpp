#pragma once
// Tapes: compiled formulas, which consist of instructions on registers.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "fields/formula/graph.hpp"

namespace oval4d::fields {

/// One operation of a tape. The register of the result may be that of an operand.
struct Instruction {
    /// The form of the operands of a binary operation: registers or numbers. Operations with fewer operands have the
    /// form two_registers.
    enum class OperandForm : std::uint8_t { two_registers, register_and_number, number_and_register };
    /// A set of axes, as bits: the axis i is 1 << i.
    using AxisSet = std::uint8_t;

    Operation operation;
    OperandForm form = OperandForm::two_registers;
    AxisSet axes = 0;                  ///< the axes along which the derivative of the result may differ from 0
    AxisSet axesOfA = 0, axesOfB = 0;  ///< the axes along which the derivatives of a and b may differ from 0
    std::uint16_t result = 0;
    std::uint16_t a = 0, b = 0;  ///< the registers of the operands; not used for a number
    double number = 0;           ///< the operand that is a number, or the exponent of integer_power
};

/// A compiled function: a sequence of instructions. The registers 0 … 3 hold the coordinates x, y, z, w, and no
/// instruction changes them. Register 4 holds the value of the function, and only the last instruction writes to it.
struct Tape {
    static constexpr std::uint16_t kResult = 4, kFirstScratch = 5;

    std::vector<Instruction> instructions;  ///< at least one
    std::size_t scratchRegisters = 0;       ///< the number of registers from kFirstScratch on
};

/// Compiles the function of the node `result`. A register is reused as soon as its value is no longer needed.
Tape compileTape(const OperationGraph& graph, OperationGraph::NodeIndex result);

}  // namespace oval4d::fields

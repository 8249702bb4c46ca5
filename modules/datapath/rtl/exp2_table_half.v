// The same in half precision (kExp2Lines): 10 and 11 digits.
module exp2_table_half (
    input [5:0] row,
    output [15:0] constant,
    output [15:0] linear
);
  reg [20:0] coefficients;
  assign constant = {6'h0F, coefficients[20:11]};
  assign linear = {5'h07, coefficients[10:0]};
  always @* begin
    case (row)
      6'd0: coefficients = 21'h00018C;
      6'd1: coefficients = 21'h00599C;
      6'd2: coefficients = 21'h00B1AA;
      6'd3: coefficients = 21'h0111BA;
      6'd4: coefficients = 21'h0169CA;
      6'd5: coefficients = 21'h01C9DA;
      6'd6: coefficients = 21'h0229EA;
      6'd7: coefficients = 21'h0289FC;
      6'd8: coefficients = 21'h02EA0C;
      6'd9: coefficients = 21'h034A1C;
      6'd10: coefficients = 21'h03AA2E;
      6'd11: coefficients = 21'h041240;
      6'd12: coefficients = 21'h047250;
      6'd13: coefficients = 21'h04DA62;
      6'd14: coefficients = 21'h054274;
      6'd15: coefficients = 21'h05AA86;
      6'd16: coefficients = 21'h061298;
      6'd17: coefficients = 21'h067AAA;
      6'd18: coefficients = 21'h06E2BE;
      6'd19: coefficients = 21'h0752D0;
      6'd20: coefficients = 21'h07C2E2;
      6'd21: coefficients = 21'h0832F6;
      6'd22: coefficients = 21'h08A30A;
      6'd23: coefficients = 21'h09131E;
      6'd24: coefficients = 21'h098330;
      6'd25: coefficients = 21'h09F344;
      6'd26: coefficients = 21'h0A6B5A;
      6'd27: coefficients = 21'h0AE36E;
      6'd28: coefficients = 21'h0B5B82;
      6'd29: coefficients = 21'h0BD398;
      6'd30: coefficients = 21'h0C4BAC;
      6'd31: coefficients = 21'h0CCBC2;
      6'd32: coefficients = 21'h0D43D8;
      6'd33: coefficients = 21'h0DC3EE;
      6'd34: coefficients = 21'h0E4402;
      6'd35: coefficients = 21'h0EC40D;
      6'd36: coefficients = 21'h0F4418;
      6'd37: coefficients = 21'h0FCC24;
      6'd38: coefficients = 21'h104C2F;
      6'd39: coefficients = 21'h10D43B;
      6'd40: coefficients = 21'h115C47;
      6'd41: coefficients = 21'h11E453;
      6'd42: coefficients = 21'h12745F;
      6'd43: coefficients = 21'h12FC6B;
      6'd44: coefficients = 21'h138C77;
      6'd45: coefficients = 21'h141C84;
      6'd46: coefficients = 21'h14AC90;
      6'd47: coefficients = 21'h15449D;
      6'd48: coefficients = 21'h15D4AA;
      6'd49: coefficients = 21'h166CB7;
      6'd50: coefficients = 21'h1704C4;
      6'd51: coefficients = 21'h179CD1;
      6'd52: coefficients = 21'h1834DF;
      6'd53: coefficients = 21'h18D4EC;
      6'd54: coefficients = 21'h1974FA;
      6'd55: coefficients = 21'h1A1508;
      6'd56: coefficients = 21'h1AB516;
      6'd57: coefficients = 21'h1B5524;
      6'd58: coefficients = 21'h1BFD32;
      6'd59: coefficients = 21'h1CA541;
      6'd60: coefficients = 21'h1D4D4F;
      6'd61: coefficients = 21'h1DFD5E;
      6'd62: coefficients = 21'h1EA56D;
      default: coefficients = 21'h1F557C;
    endcase
  end
endmodule
